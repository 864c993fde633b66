/** What a gesture does to points, each of which has a share in it, 0 to 1. */

import { type Box, boxOf, type Point } from './geometry';

export const moved = (points: readonly Point[], share: readonly number[], dx: number, dy: number): Point[] =>
  points.map(([x, y], index) => [x + dx * (share[index] ?? 0), y + dy * (share[index] ?? 0)]);

/** The selected points made larger and turned (radians, clockwise) around their middle. */
export function resized(points: readonly Point[], share: readonly number[], factor: number, angle: number): Point[] {
  const [cx, cy] = middle(points, share);
  const [cos, sin] = [Math.cos(angle) * factor, Math.sin(angle) * factor];
  return points.map(([x, y], index) => {
    if (!share[index]) return [x, y];
    const [dx, dy] = [x - cx, y - cy];
    return [cx + cos * dx - sin * dy, cy + sin * dx + cos * dy];
  });
}

/** The box around the points that take part. */
export function boxAround(points: readonly Point[], share: readonly number[] = points.map(() => 1)): Box {
  return boxOf(points.filter((_, index) => share[index]));
}

/** The middle of the box around the points that take part. */
export function middle(points: readonly Point[], share: readonly number[]): Point {
  const { x, y, width, height } = boxAround(points, share);
  return [x + width / 2, y + height / 2];
}

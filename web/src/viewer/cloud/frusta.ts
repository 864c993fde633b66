/** Cameras as pyramids: the eye, and what it sees at a little distance. */

import { BufferGeometry, Float32BufferAttribute, LineBasicMaterial, LineSegments } from 'three';

/** A camera that sees a point p of the world, metres, at K (R p + t), pixels. */
export interface PinholeCamera {
  size: readonly [width: number, height: number];
  /** K, R and t, in rows. */
  intrinsics: readonly (readonly number[])[];
  rotation: readonly (readonly number[])[];
  translation: readonly number[];
}

type Point = [number, number, number];

/** The eye, then the four corners of the picture at `depth` metres from it. */
export function corners({ size: [width, height], intrinsics, rotation, translation }: PinholeCamera, depth: number): Point[] {
  const at = (row: number, column: number): number => intrinsics[row]?.[column] ?? 0;
  const world = (seen: Point): Point => {
    const back = seen.map((value, axis) => value - (translation[axis] ?? 0));
    return [0, 1, 2].map((axis) => back.reduce((sum, value, row) => sum + (rotation[row]?.[axis] ?? 0) * value, 0)) as Point;
  };
  const pixel = (x: number, y: number): Point =>
    world([((x - at(0, 2)) / at(0, 0)) * depth, ((y - at(1, 2)) / at(1, 1)) * depth, depth]);
  return [world([0, 0, 0]), pixel(0, 0), pixel(width, 0), pixel(width, height), pixel(0, height)];
}

/** From the eye to each corner, and around. */
const EDGES = [0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1];

export function frusta(cameras: readonly PinholeCamera[], depth: number, colour: number): LineSegments<BufferGeometry, LineBasicMaterial> {
  const ends = cameras.flatMap((camera) => {
    const points = corners(camera, depth);
    return EDGES.flatMap((corner) => points[corner]!);
  });
  const geometry = new BufferGeometry().setAttribute('position', new Float32BufferAttribute(ends, 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: colour }));
}

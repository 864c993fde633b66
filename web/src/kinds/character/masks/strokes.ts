/** Strokes of a brush over the picture: as they are drawn, and as they are sent. */

import type { BodyPart, Stroke } from '../types';
import { type Point, toSegment } from '../../../picture_editor/geometry';

export type MaskStroke = Stroke & { person: boolean };
export type LabelStroke = Stroke & { part: BodyPart };

/** The colours of labels.png. */
export const partColours: Record<BodyPart, string> = {
  head: 'rgb(250 180 60)',
  torso: 'rgb(220 80 80)',
  left_arm: 'rgb(80 220 80)',
  right_arm: 'rgb(60 160 220)',
  left_leg: 'rgb(200 80 200)',
  right_leg: 'rgb(60 220 220)',
};

/** A stroke as an SVG path; one that is a single dab is a point, which round ends make a disc. */
export const outline = ({ path }: Stroke): string =>
  path.length === 1 ? `M${path[0]?.join(' ')}h0` : `M${path.map((place) => place.join(' ')).join('L')}`;

/** How far a path may be from the one that was drawn, as a share of the brush's radius. */
const LOOSE = 1 / 16;

/** A stroke with no more places than it needs, in tenths of a pixel. */
export function simplified<Kind extends Stroke>(stroke: Kind): Kind {
  const kept = fewer(stroke.path, Math.max(0.3, stroke.radius * LOOSE));
  const tenth = (value: number): number => Math.round(value * 10) / 10;
  return { ...stroke, radius: tenth(stroke.radius), path: kept.map(([x, y]) => [tenth(x), tenth(y)]) };
}

/** A path whose ends are those of another and which is never further from it than that (Douglas and Peucker, 1973). */
export function fewer(path: readonly Point[], within: number): Point[] {
  const [first, last] = [path[0], path.at(-1)];
  if (!first || !last || path.length < 3) return [...path];
  let furthest = 0;
  let largest = within;
  path.forEach((place, index) => {
    const distance = toSegment(place, first, last);
    if (distance > largest) [furthest, largest] = [index, distance];
  });
  if (!furthest) return path.length > 1 ? [first, last] : [first];
  return [...fewer(path.slice(0, furthest + 1), within).slice(0, -1), ...fewer(path.slice(furthest), within)];
}

/** Radii of the brush, thin and thick, in pixels of a picture of this size; steps between them grow with it. */
export const radii = ([width, height]: readonly [number, number]): { min: number; max: number; usual: number } => {
  const longest = Math.max(width, height);
  return { min: longest / 600, max: longest / 8, usual: longest / 60 };
};

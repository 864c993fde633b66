/** The 68 points of the iBUG scheme, grouped by the features that they outline. */

import type { Point } from '../../../picture_editor/geometry';

export type Points = readonly Point[];

/** Features from top to bottom; left and right are those of the picture. */
export const features = ['leftBrow', 'rightBrow', 'leftEye', 'rightEye', 'nose', 'lips', 'chin'] as const;
export type Feature = (typeof features)[number];

/** A run of points that a line joins. */
export interface Line {
  feature: Feature;
  from: number;
  /** The number after the last one. */
  to: number;
  closed: boolean;
}

export const lines: readonly Line[] = [
  { feature: 'chin', from: 0, to: 17, closed: false },
  { feature: 'leftBrow', from: 17, to: 22, closed: false },
  { feature: 'rightBrow', from: 22, to: 27, closed: false },
  { feature: 'nose', from: 27, to: 31, closed: false },
  { feature: 'nose', from: 31, to: 36, closed: false },
  { feature: 'leftEye', from: 36, to: 42, closed: true },
  { feature: 'rightEye', from: 42, to: 48, closed: true },
  { feature: 'lips', from: 48, to: 60, closed: true },
  { feature: 'lips', from: 60, to: 68, closed: true },
];

export const POINTS = 68;

export const lineOf = (index: number): Line => {
  const line = lines.find(({ from, to }) => index >= from && index < to);
  if (!line) throw new RangeError(`no point ${index}`);
  return line;
};

/** The numbers of a feature's points, in order. */
export const membersOf = (feature: Feature): number[] =>
  lines
    .filter((line) => line.feature === feature)
    .flatMap(({ from, to }) => Array.from({ length: to - from }, (_, place) => from + place));

/** How many steps along its line lie between two points; infinitely many where they are on different lines. */
export function steps(a: number, b: number): number {
  const { from, to, closed } = lineOf(a);
  if (b < from || b >= to) return Infinity;
  const apart = Math.abs(a - b);
  return closed ? Math.min(apart, to - from - apart) : apart;
}

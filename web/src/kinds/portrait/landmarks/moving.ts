/** What a gesture takes hold of: which landmarks, and by how much. */

import { type Point, toSegment } from '../../../picture_editor/geometry';
import { type Feature, lines, membersOf, POINTS, steps } from './scheme';

/** What moves: the whole face, a feature of it, or one of a feature's points. */
export type Selection =
  | { by: 'face' }
  | { by: 'feature'; feature: Feature }
  | { by: 'point'; feature: Feature; index: number };

/** How much of a point's move its neighbours on the line make, by the steps between them. */
const FALLOFF = [1, 0.5, 0.15];

/** Each point's share in a move of the selection, 0 to 1. `soft`: a single point takes its neighbours along. */
export function shares(selection: Selection, soft: boolean): number[] {
  const all = Array.from({ length: POINTS }, (_, index) => index);
  switch (selection.by) {
    case 'face':
      return all.map(() => 1);
    case 'feature': {
      const members = new Set(membersOf(selection.feature));
      return all.map((index) => (members.has(index) ? 1 : 0));
    }
    case 'point':
      return all.map((index) => {
        const distance = steps(selection.index, index);
        return soft ? (FALLOFF[distance] ?? 0) : distance === 0 ? 1 : 0;
      });
  }
}

/** The feature whose lines pass nearest to a place, if one does within reach. */
export function nearestFeature(points: readonly Point[], place: Point, reach: number): Feature | null {
  let found: Feature | null = null;
  let shortest = reach;
  for (const { feature, from, to, closed } of lines) {
    for (let index = from; index < to; index++) {
      const next = index + 1 < to ? index + 1 : closed ? from : index;
      const distance = toSegment(place, points[index] ?? place, points[next] ?? place);
      if (distance <= shortest) [found, shortest] = [feature, distance];
    }
  }
  return found;
}

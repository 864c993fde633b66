/** The faces of a collection by what became of them. */

import { type Face, type FaceSheet, reasons } from '../types';

export interface FaceGroup {
  /** Null: they are used. */
  reason: string | null;
  /** Numbers of faces. */
  faces: readonly number[];
}

/** Those that are used, then the others by what speaks against them: in the order of `reasons`, and by what has no place there. */
export function groupsOf({ faces }: FaceSheet): FaceGroup[] {
  const told = new Set([null, ...reasons, ...faces.map(reasonOf)]);
  return [...told]
    .map((reason) => ({ reason, faces: faces.flatMap((face, number) => (reasonOf(face) === reason ? [number] : [])) }))
    .filter(({ faces }) => faces.length > 0);
}

const reasonOf = ({ kept, reason }: Face): string | null => (kept ? null : reason);

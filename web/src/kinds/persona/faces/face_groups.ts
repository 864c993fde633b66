/** The faces of a collection by what became of them. */

import { type Face, type FaceSheet, type Reason, reasons } from '../types';

export interface FaceGroup {
  /** Null: they are used. */
  reason: Reason | null;
  /** Numbers of faces. */
  faces: readonly number[];
}

/** Those that are used, then the others by what speaks against them; groups without faces are left out. */
export function groupsOf({ faces }: FaceSheet): FaceGroup[] {
  const of = (reason: Reason | null): number[] => faces.flatMap((face, number) => (reasonOf(face) === reason ? [number] : []));
  return [null, ...reasons].map((reason) => ({ reason, faces: of(reason) })).filter(({ faces }) => faces.length > 0);
}

const reasonOf = ({ kept, reason }: Face): Reason | null => (kept ? null : reason);

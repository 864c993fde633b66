/** How somebody moves: what can be chosen for it, and what is known of a file. */

import type { Schemas } from '../api';

/** A built-in motion. */
export type MotionName = NonNullable<Schemas['CharacterOptions']['motion']>;

/** How somebody moves: one of our clips, or a file. */
export type Motion =
  | { by: 'name'; name: MotionName }
  /** One of the user's own, which the service keeps. */
  | { by: 'kept'; name: string }
  | { by: 'file'; file: File };

/** What is kept of a job: the file that it had before. */
export type GivenInput = { by: 'held'; input: string };

/** Which joint of a motion's file moves which of ours, where it is not as found; null leaves one out. */
export type MotionJoints = Readonly<Record<string, string | null>>;

/** What is in a motion file (motion.json); only what this page reads. */
export interface MotionDetails {
  /** The joints of its skeleton. */
  joints: readonly { name: string }[];
  /** Which of them moves which of ours, as it was found. */
  mapping: Readonly<Record<string, string>>;
  /** The names of its animations, where it has several. */
  clips?: readonly string[];
}

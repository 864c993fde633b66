/** What a character takes, and what it leaves that is read here. */

import type { Frame, Job, Report, Schemas } from '../../api';
import type { MotionJoints, MotionName } from '../../motion/types';

/** A path of a brush over the picture, both in its pixels. */
export interface Stroke {
  path: [number, number][];
  radius: number;
}
export type BodyPart = 'head' | 'torso' | 'left_arm' | 'right_arm' | 'left_leg' | 'right_leg';
export interface CharacterCorrections {
  /** Where the person is looked for. */
  person_box?: Frame;
  /** Which of the people found, counted from the largest, or all of them. */
  person_index?: number | 'all' | null;
  /** Joints by their names in skeleton.json. */
  joints?: Record<string, [number, number]>;
  mask_strokes?: (Stroke & { person: boolean })[];
  label_strokes?: (Stroke & { part: BodyPart })[];
  motion_joints?: MotionJoints;
  /** A file or a kept motion, in place of the motion that is named. */
  motion?: string;
  /** Files in place of what would be found, of the picture's size. */
  mask?: string;
  labels?: string;
}
export type CharacterOptions = Omit<Partial<Schemas['CharacterOptions']>, keyof CharacterCorrections> &
  Omit<CharacterCorrections, 'motion' | 'mask' | 'labels'> & {
    motion?: MotionName;
    back_texture?: 'see_through' | 'mirror' | 'inpaint';
    surface?: 'auto' | 'hybrid' | 'relief' | 'shell';
  };

/** Null takes one back: to what is found by itself, or to the default. */
type Changes<T> = { [Name in keyof T]?: T[Name] | null };
export interface CharacterChanges {
  corrections: Changes<CharacterCorrections>;
  options: Changes<CharacterOptions>;
  metadata?: Schemas['JobOut']['metadata'];
}

export const characterOptions = (of: Job): CharacterOptions => of.options as CharacterOptions;

export type CharacterReport = Report<{
  /** The people found in the picture, the largest first; and which of them was taken. */
  people?: Frame[];
  person?: number | 'all' | null;
}>;

/** The boxes of the people that a failed job has found. */
export const foundPeople = (of: Job): Frame[] => (of.error?.found as { people?: Frame[] } | undefined)?.people ?? [];

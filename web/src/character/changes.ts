/** What a revision of a character asks for: nothing but what differs from the job before. */

import { characterOptions, type CharacterChanges, type Frame, type Job } from '../api';
import { stem } from '../format';
import { USUAL_MOTION } from '../names';
import type { Motion } from '../order';
import type { Pose } from '../components/redo';
import { plain } from '../strings';
import { changedOptions, type Choices, choicesOf } from './choices';
import type { Joints } from './skeleton';
import type { LabelStroke, MaskStroke } from './strokes';

export interface Wishes extends Choices {
  /** Which of the people found, counted from the largest. */
  person: number | 'all';
  /** Where the person is looked for; null for the whole picture. */
  box: Frame | null;
  /** Joints that are placed by hand. */
  joints: Joints;
  mask: readonly MaskStroke[];
  labels: readonly LabelStroke[];
  /** `held`: the file that the job had before. */
  motion: Motion | { by: 'held' };
  pose: Pose;
}

/** What a job was made with. */
export function wishesOf(job: Job): Wishes {
  const made = characterOptions(job);
  return {
    ...choicesOf(made),
    person: made.person_index ?? 0,
    box: made.person_box ?? null,
    joints: made.joints ?? {},
    mask: made.mask_strokes ?? [],
    labels: made.label_strokes ?? [],
    motion: job.inputs.motion ? { by: 'held' } : { by: 'name', name: made.motion ?? USUAL_MOTION },
    pose: (made.pose as Pose | undefined) ?? {},
  };
}

/** Somebody else in the picture: what was put right of the one before is no longer wanted. */
export const another = (who: { person: number | 'all' } | { box: Frame | null }): Partial<Wishes> => ({
  ...('person' in who ? { person: who.person, box: null } : { person: 0, box: who.box }),
  ...{ joints: {}, mask: [], labels: [], pose: {} },
});

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** `motionFile` is the id of the file that was sent, where the motion is one. */
export function changesOf(before: Wishes, now: Wishes, motionFile: string | null): CharacterChanges {
  const filled = <T extends object>(value: T): T | null => (Object.keys(value).length ? value : null);
  const { motion } = now;
  const renamed = motion.by === 'name' && !same(before.motion, motion);
  const corrections = {
    ...(!same(before.person, now.person) && { person_index: now.person || null }),
    ...(!same(before.box, now.box) && { person_box: now.box }),
    ...(!same(before.joints, now.joints) && { joints: filled(now.joints) }),
    ...(!same(before.mask, now.mask) && { mask_strokes: filled(now.mask) }),
    ...(!same(before.labels, now.labels) && { label_strokes: filled(now.labels) }),
    ...(motionFile && { motion: motionFile }),
    ...(renamed && before.motion.by === 'held' && { motion: null }),
  };
  const options = {
    ...changedOptions(before, now),
    ...(renamed && { motion: motion.name }),
    ...(!same(before.pose, now.pose) && { pose: filled(now.pose) }),
  };
  return { corrections, options } as CharacterChanges;
}

export const isChanged = (before: Wishes, now: Wishes): boolean => {
  const { corrections, options } = changesOf(before, now, now.motion.by === 'file' ? 'file' : null);
  return Object.keys({ ...corrections, ...options }).length > 0;
};

/** The job's own notes, with the name of its new motion. */
export const notesFor = (job: Job, motion: File): Job['metadata'] => ({ ...job.metadata, motion: plain(stem(motion.name)) });

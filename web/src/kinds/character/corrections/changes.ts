/** What a revision of a character asks for: nothing but what differs from the job before. */

import type { Frame, Job } from '../../../api';
import { characterOptions, type CharacterChanges } from '../types';
import type { Pose } from '../../../viewer/posing/pose';
import { stem } from '../../../language/format';
import { type MotionDraft, motionChanges, motionDraftOf } from '../../../motion/draft';
import { DEFAULT_MOTION } from '../../../motion/motion_names';
import type { GivenInput } from '../../../motion/types';
import { plain } from '../../../language/strings';
import type { Revision } from '../../../sending/use_revision';
import { changedOptions, type Choices, choicesOf } from '../choices';
import type { Joints } from '../joints/skeleton';
import type { LabelStroke, MaskStroke } from '../masks/strokes';

export interface RevisionDraft extends Choices, MotionDraft {
  /** Which of the people found, counted from the largest; null where that is asked. */
  person: number | 'all' | null;
  /** Where the person is looked for; null for the whole picture. */
  box: Frame | null;
  /** Joints that are placed by hand. */
  joints: Joints;
  mask: readonly MaskStroke[];
  labels: readonly LabelStroke[];
  /** Files in place of what is found; strokes are painted over them. */
  maskFile: File | GivenInput | null;
  labelsFile: File | GivenInput | null;
  pose: Pose;
}

/** What of the draft is files to be sent, and their ids once they are. */
export const fileParts = ['motion', 'mask', 'labels'] as const;
export type Sent = { [Part in (typeof fileParts)[number]]?: string };

/** The file to be sent for a part; null where there is none. */
export function fileOf(draft: RevisionDraft, part: keyof Sent): File | null {
  const { motion, maskFile, labelsFile } = draft;
  if (part === 'motion') return motion.by === 'file' ? motion.file : null;
  const file = part === 'mask' ? maskFile : labelsFile;
  return file instanceof File ? file : null;
}

/** What a job was made with. */
export function draftOf(job: Job): RevisionDraft {
  const made = characterOptions(job);
  const held = (name: string): GivenInput | null => {
    const input = job.inputs[name];
    return typeof input === 'string' ? { by: 'held', input } : null;
  };
  return {
    ...choicesOf(made),
    ...motionDraftOf(job, DEFAULT_MOTION),
    person: made.person_index ?? (job.error?.code === 'crowd' ? null : 0),
    box: made.person_box ?? null,
    joints: made.joints ?? {},
    mask: made.mask_strokes ?? [],
    labels: made.label_strokes ?? [],
    maskFile: held('mask'),
    labelsFile: held('labels'),
    pose: (made.pose as Pose | undefined) ?? {},
  };
}

/**
 * Somebody else in the picture: what was put right of the one before is no longer wanted. A box stands for whoever is chosen;
 * they are again once it is taken away.
 */
export const forPerson = (who: { person: number | 'all' } | { box: Frame | null }): Partial<RevisionDraft> => ({
  ...('person' in who ? { person: who.person, box: null } : who),
  ...{ joints: {}, mask: [], labels: [], maskFile: null, labelsFile: null, pose: {} },
});

/** Whether all of the people are wanted. */
export const isEverybody = ({ person, box }: RevisionDraft): boolean => person === 'all' && !box;

/** A box holds one person: beside it there is a number, of whoever is chosen when it goes. */
const indexOf = ({ person, box }: RevisionDraft): RevisionDraft['person'] => (box && typeof person !== 'number' ? 0 : person);

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** `sent`: the ids of the files that were sent. */
export function changesOf(before: RevisionDraft, now: RevisionDraft, sent: Sent): CharacterChanges {
  const filled = <T extends object>(value: T): T | null => (Object.keys(value).length ? value : null);
  const moved = motionChanges(before, now);
  const corrections = {
    ...(!same(indexOf(before), indexOf(now)) && { person_index: indexOf(now) }),
    ...(!same(before.box, now.box) && { person_box: now.box }),
    ...(!same(before.joints, now.joints) && { joints: filled(now.joints) }),
    ...(before.maskFile && !now.maskFile && { mask: null }),
    ...(before.labelsFile && !now.labelsFile && { labels: null }),
    ...(!same(before.mask, now.mask) && { mask_strokes: filled(now.mask) }),
    ...(!same(before.labels, now.labels) && { label_strokes: filled(now.labels) }),
    ...moved.corrections,
    ...sent,
  };
  const options = {
    ...changedOptions(before, now),
    ...moved.options,
    ...(!same(before.pose, now.pose) && { pose: filled(now.pose) }),
  };
  return { corrections, options } as CharacterChanges;
}

export const isChanged = (before: RevisionDraft, now: RevisionDraft): boolean => {
  const { corrections, options } = changesOf(before, now, {});
  return fileParts.some((part) => fileOf(now, part)) || Object.keys({ ...corrections, ...options }).length > 0;
};

/** The job's own notes, with the name of its new motion; nothing where it has none. */
export function notesFor(job: Job, { motion }: RevisionDraft): { metadata?: Job['metadata'] } {
  const name = motion.by === 'file' ? stem(motion.file.name) : motion.by === 'kept' ? motion.name : null;
  return name === null ? {} : { metadata: { ...job.metadata, motion: plain(name) } };
}

/** The order of a revision: its files, and what is asked for once they have arrived. */
export const revisionOf = (job: Job, before: RevisionDraft, now: RevisionDraft): Revision => ({
  files: fileParts.flatMap((part) => {
    const file = fileOf(now, part);
    return file ? [[part, file] as const] : [];
  }),
  changes: (sent) => ({ ...changesOf(before, now, sent), ...notesFor(job, now) }),
});

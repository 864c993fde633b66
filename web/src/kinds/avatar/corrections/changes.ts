/** What a revision of an avatar asks for: nothing but what differs from the job before. */

import type { Changes, Job } from '../../../api';
import { fileTitle } from '../../../language/format';
import { type MotionDraft, motionChanges, motionDraftOf, motionTitle } from '../../../motion/draft';
import type { Revision } from '../../../sending/use_revision';
import { textOf } from '../../../works/inputs';
import { heightIn } from '../height';
import { avatarOptions, type ClipName, clipNames, USUAL_MOTION } from '../types';

/** Where a joint is in frames of the body clip, in its own pixels. */
export type Places = readonly { readonly frame: number; readonly place: readonly [number, number] }[];
export type Landmarks = Readonly<Record<string, Places>>;

/** Frames in which a joint has to be shown: one alone does not say how far away it is. */
export const MIN_LANDMARK_FRAMES = 2;

/** What is chosen in the folded options. */
const choices = ['body_frames', 'head_frames', 'texture_size', 'triangles', 'levels', 'vrm', 'vrm_author', 'size', 'fps', 'seconds'];

export interface RevisionDraft extends MotionDraft {
  /** As it is written. */
  height: string;
  leftOut: Readonly<Record<ClipName, readonly number[]>>;
  landmarks: Landmarks;
  /** Another video; null for none; `held`: as before. */
  driver: File | null | 'held';
  options: Readonly<Record<string, unknown>>;
}

/** What a job was made with. */
export function draftOf(job: Job): RevisionDraft {
  const made = avatarOptions(job);
  return {
    ...motionDraftOf(job, USUAL_MOTION),
    height: made.height_m == null ? '' : String(made.height_m),
    leftOut: { body: made.body_frames_left_out ?? [], head: made.head_frames_left_out ?? [] },
    landmarks: (made.landmarks ?? {}) as Landmarks,
    driver: textOf(job.inputs.driver) ? 'held' : null,
    options: Object.fromEntries(Object.entries(made).filter(([name]) => choices.includes(name))),
  };
}

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** Joints that are shown in frames enough. */
export const placedIn = (landmarks: Landmarks): Landmarks =>
  Object.fromEntries(Object.entries(landmarks).filter(([, places]) => places.length >= MIN_LANDMARK_FRAMES));

/** `sent`: the ids of the files that were sent. */
export function changesOf(before: RevisionDraft, now: RevisionDraft, sent: Readonly<Record<string, string>> = {}): Changes {
  const moved = motionChanges(before, now);
  const [landmarks, known] = [placedIn(now.landmarks), placedIn(before.landmarks)];
  const leftOut = clipNames.filter((clip) => !same(now.leftOut[clip], before.leftOut[clip]));
  const changed = choices.filter((name) => !same(now.options[name], before.options[name]));
  return {
    corrections: {
      ...(heightIn(now.height) !== heightIn(before.height) && { height_m: heightIn(now.height) }),
      ...Object.fromEntries(leftOut.map((clip) => [`${clip}_frames_left_out`, now.leftOut[clip].length ? now.leftOut[clip] : null])),
      ...(!same(landmarks, known) && { landmarks: Object.keys(landmarks).length ? landmarks : null }),
      ...(now.driver === null && before.driver !== null && { driver: null }),
      ...moved.corrections,
      ...sent,
    },
    options: { ...Object.fromEntries(changed.map((name) => [name, now.options[name] ?? null])), ...moved.options },
  };
}

function filesOf({ motion, driver }: RevisionDraft): Revision['files'] {
  return [
    ...(motion.by === 'file' ? [['motion', motion.file] as const] : []),
    ...(driver instanceof File ? [['driver', driver] as const] : []),
  ];
}

export function isChanged(before: RevisionDraft, now: RevisionDraft): boolean {
  const { corrections, options } = changesOf(before, now);
  return filesOf(now).length > 0 || Object.keys({ ...corrections, ...options }).length > 0;
}

export const revisionOf = (job: Job, before: RevisionDraft, now: RevisionDraft): Revision => ({
  files: filesOf(now),
  changes: (sent) => ({ ...changesOf(before, now, sent), ...notesFor(job, now) }),
});

/** The job's own notes, with the name of what it acts out now; nothing where that is as before. */
function notesFor({ metadata }: Job, { motion, driver }: RevisionDraft): Pick<Changes, 'metadata'> {
  const { performance: _before, ...others } = metadata as Record<string, string>;
  if (driver instanceof File) return { metadata: { ...others, performance: fileTitle(driver) } };
  if (motion.by === 'held' || driver === 'held') return {};
  return { metadata: motion.by === 'name' ? others : { ...others, performance: motionTitle(motion) } };
}

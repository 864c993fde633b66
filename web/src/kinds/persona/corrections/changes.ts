/** What a revision of a persona asks for: nothing but what differs from the job before. */

import type { Changes, Job } from '../../../api';
import type { Performance } from '../../../performances/performance';
import { performanceTitle } from '../../../performances/performance';
import type { Revision } from '../../../sending/use_revision';
import { type Face, personaOptions } from '../types';

/** What is chosen in the folded options. */
const choices = ['composite', 'photo', 'average_light', 'background', 'light', 'size', 'fps', 'sound', 'texture_width'];

export interface RevisionDraft {
  /** Numbers of faces that are used, whatever speaks against them. */
  keep: readonly number[];
  leaveOut: readonly number[];
  /** A face of the person that is meant; null: found by itself. */
  example: number | null;
  performance: Performance | 'held';
  options: Readonly<Record<string, unknown>>;
}

/** What a job was made with. */
export function draftOf(job: Job): RevisionDraft {
  const made = personaOptions(job);
  return {
    keep: made.keep ?? [],
    leaveOut: made.leave_out ?? [],
    example: made.example ?? null,
    performance: 'held',
    options: Object.fromEntries(Object.entries(made).filter(([name]) => choices.includes(name))),
  };
}

type Decisions = Pick<RevisionDraft, 'keep' | 'leaveOut'>;

/** Whether a face is to be used, of which the job before says what became of it then. */
export function isUsed(number: number, face: Face, before: Decisions, now: Decisions): boolean {
  if (now.keep.includes(number)) return true;
  if (now.leaveOut.includes(number)) return false;
  // what somebody had decided, and no longer does, is again as it is by itself: it would not have been decided otherwise
  if (before.keep.includes(number)) return false;
  if (before.leaveOut.includes(number)) return true;
  return face.kept;
}

/** The decisions with the other one about this face; back to none where that is what it is by itself. */
export function toggled(number: number, face: Face, before: Decisions, now: Decisions): Decisions {
  const without = (all: readonly number[]): number[] => all.filter((one) => one !== number);
  const [keep, leaveOut] = [without(now.keep), without(now.leaveOut)];
  const wanted = !isUsed(number, face, before, now);
  if (isUsed(number, face, before, { keep, leaveOut }) === wanted) return { keep, leaveOut };
  const sorted = (all: number[]): number[] => all.sort((one, other) => one - other);
  return wanted ? { keep: sorted([...keep, number]), leaveOut } : { keep, leaveOut: sorted([...leaveOut, number]) };
}

const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** `sent`: the ids of the files that were sent. */
export function changesOf(before: RevisionDraft, now: RevisionDraft, sent: Readonly<Record<string, string>> = {}): Changes {
  const { performance } = now;
  const changed = choices.filter((name) => !same(now.options[name], before.options[name]));
  return {
    corrections: {
      ...(!same(now.keep, before.keep) && { keep: now.keep.length ? now.keep : null }),
      ...(!same(now.leaveOut, before.leaveOut) && { leave_out: now.leaveOut.length ? now.leaveOut : null }),
      ...(now.example !== before.example && { example: now.example }),
      ...(performance !== 'held' && performance.by === 'name' && { driver: performance.name }),
      ...sent,
    },
    options: Object.fromEntries(changed.map((name) => [name, now.options[name] ?? null])),
  };
}

const filesOf = ({ performance }: RevisionDraft): Revision['files'] =>
  performance !== 'held' && performance.by === 'file' ? [['driver', performance.file]] : [];

export function isChanged(before: RevisionDraft, now: RevisionDraft): boolean {
  const { corrections, options } = changesOf(before, now);
  return filesOf(now).length > 0 || Object.keys({ ...corrections, ...options }).length > 0;
}

export const revisionOf = (job: Job, before: RevisionDraft, now: RevisionDraft): Revision => ({
  files: filesOf(now),
  changes: (sent) => ({ ...changesOf(before, now, sent), ...notesFor(job, now) }),
});

/** The job's own notes, with the name of what it plays now; nothing where that is as before. */
const notesFor = ({ metadata }: Job, { performance }: RevisionDraft): Pick<Changes, 'metadata'> =>
  performance === 'held' ? {} : { metadata: { ...metadata, performance: performanceTitle(performance) } };

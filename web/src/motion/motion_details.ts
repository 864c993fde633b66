/** What is in a motion that somebody chose: a kept one is known already, a file is looked into by a job of its own. */

import { deleteJob, getJob, getMotion, type Job, type KeptMotion, orderMotionCheck, Problem, readArtifact } from '../api';
import { finished } from '../api/events';
import { isFileId, isUrl } from '../works/inputs';
import type { GivenInput, Motion, MotionDetails } from './types';

/** How often the job is asked how far it is. */
const POLL_MS = 400;

/** A motion that is no clip of ours; of a job, what it was given, by name, id or address. */
export type OwnMotion = Exclude<Motion, { by: 'name' }> | GivenInput;

/** Tells one motion from another. */
export const keyOf = (motion: OwnMotion): string => {
  if (motion.by === 'file') return `file ${motion.file.name} ${motion.file.size} ${motion.file.lastModified}`;
  return motion.by === 'kept' ? `kept ${motion.name}` : `held ${motion.input}`;
};

/** Whether a motion can move somebody, if need be once its joints are told. */
export const canMove = ({ check_status, error, missing }: KeptMotion): boolean =>
  check_status === 'ready' && (!error || (missing?.length ?? 0) > 0);

/** Raises the `Problem` for which nothing can be told of it. */
export async function detailsOf(motion: OwnMotion, signal: AbortSignal): Promise<MotionDetails> {
  if (motion.by === 'file') return look(motion.file, signal);
  const name = motion.by === 'kept' ? motion.name : motion.input;
  if (motion.by === 'held' && (isUrl(name) || isFileId(name))) return look(name, signal);
  const { joints = [], mapping = {}, clips = [] } = await getMotion(name, signal);
  return { joints, mapping, clips };
}

async function look(motion: string | File, signal: AbortSignal): Promise<MotionDetails> {
  let job: Job = await orderMotionCheck(motion);
  try {
    while (!finished(job) && !signal.aborted) {
      await new Promise((wake) => setTimeout(wake, POLL_MS));
      job = await getJob(job.id, signal);
    }
    const found = await readArtifact<MotionDetails>(job, 'motion.json', signal);
    if (!found) throw new Problem(0, job.error?.code ?? 'internal_error', job.error?.detail ?? '');
    return found;
  } finally {
    // it has told all that it was for
    deleteJob(job.id).catch(() => undefined);
  }
}

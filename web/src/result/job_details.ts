/**
 * What a job's page shows beside the job itself, and the part that shows its result: read before any of it is drawn. What
 * came one after the other would push what stands below it away from under the pointer, and a click would be lost.
 */

import { getReport, type Job, listRevisions, type Problem, type Report } from '../api';
import { finished } from '../api/events';
import { asProblem, useLoaded } from '../api/loading';
import type { Kind } from '../kind/kind';
import { preload } from '../widgets/lazy';

export interface JobDetails {
  /** The job as it is to be drawn: as it was, until what belongs to its end is there too. */
  job: Job;
  /** The job and all that was made of it, oldest first; empty where they could not be read. */
  versions: readonly Job[];
  /** Null where it left none, or could not be read. */
  report: Report | null;
  /** Why the report could not be read. */
  problem: Problem | null;
  reload: () => void;
}

/** Null until they are there for the first time. */
export function useJobDetails(job: Job | null, kindOf: (name: string) => Kind): JobDetails | null {
  const key = job ? `${job.id} ${finished(job)}` : '';
  const { value, reload } = useLoaded(async (signal) => {
    if (!job) return null;
    const versions = listRevisions(job.id, signal).catch(() => []);
    // where it does not come, the page says so in its place
    const part = job.status === 'succeeded' && preload(kindOf(job.kind).loadResult).catch(() => null);
    const [report, problem] = await getReport<Report>(job, signal).then(
      (read) => [read, null] as const,
      (error: unknown) => [null, asProblem(error)] as const,
    );
    await part;
    return { key, job, report, problem, versions: await versions };
  }, key);
  if (!job || !value) return null;
  return { ...value, job: value.key === key ? job : value.job, reload };
}

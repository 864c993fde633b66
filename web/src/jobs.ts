/** A list of jobs, page by page; what is under way is looked at again from time to time. */

import { useEffect, useState } from 'preact/hooks';
import { type Job, listJobs, type Problem, type Status } from './api';
import { asProblem, useLoaded } from './loading';

const REFRESH_MS = 4000;

export interface JobList {
  /** Null while the first page is loaded. */
  jobs: Job[] | null;
  problem: Problem | null;
  retry: () => void;
  /** Loads the next page; null where there is none. */
  more: (() => Promise<void>) | null;
}

/** The jobs of one status, or all; a page has `size` of them. */
export function useJobs(size: number, status: Status | null): JobList {
  const first = useLoaded((signal) => listJobs({ size, status, cursor: null }, signal), `jobs ${status}`);
  const [older, setOlder] = useState<Job[]>([]);
  const [next, setNext] = useState<string | null | undefined>(undefined);
  const [problem, setProblem] = useState<Problem | null>(null);

  const busy = first.value?.items.some((job) => job.status === 'queued' || job.status === 'running') ?? false;
  useEffect(() => {
    if (!busy) return;
    const timer = setInterval(first.reload, REFRESH_MS);
    return () => clearInterval(timer);
  }, [busy]);

  if (!first.value) return { jobs: null, problem: first.problem, retry: first.reload, more: null };
  const known = new Set(first.value.items.map((job) => job.id));
  const cursor = next === undefined ? first.value.next_cursor : next;
  const more = async (): Promise<void> => {
    setProblem(null);
    try {
      const page = await listJobs({ size, status, cursor });
      setOlder([...older, ...page.items]);
      setNext(page.next_cursor);
    } catch (error) {
      setProblem(asProblem(error));
    }
  };
  return {
    jobs: [...first.value.items, ...older.filter((job) => !known.has(job.id))],
    problem: problem ?? first.problem,
    retry: problem ? () => void more() : first.reload,
    more: cursor ? more : null,
  };
}

/** A list of works, page by page, each as its newest job; what is under way is looked at again from time to time. */

import { useEffect, useState } from 'preact/hooks';
import { type Job, listWorks, type Problem, type Wanted } from '../api';
import { asProblem, useLoaded } from '../api/loading';
import { useOffered } from '../kind/offered';

const REFRESH_MS = 4000;

export const allWorks = { status: null, words: '' };

export interface WorkList {
  /** Null while the first page is loaded. */
  jobs: Job[] | null;
  /** How many versions each work has, by its id. */
  versions: Readonly<Record<string, number>>;
  /** What is shown is still that of an earlier wish. */
  stale: boolean;
  problem: Problem | null;
  retry: () => void;
  /** Loads the next page; null where there is none. */
  more: (() => Promise<void>) | null;
}

/** What followed the first page of a list, which is known by its key. */
interface Later {
  key: string;
  jobs: Job[];
  versions: Readonly<Record<string, number>>;
  next: string | null;
}

/** The works that are wanted, of all kinds where none are named; a page has `size` of them. */
export function useWorks(size: number, { kinds, status, words }: Omit<Wanted, 'kinds'> & Partial<Wanted>): WorkList {
  const offered = useOffered().map(({ name }) => name);
  const wanted: Wanted = { kinds: kinds ?? offered, status, words };
  const key = `${wanted.kinds} ${status} ${words}`;
  const first = useLoaded(async (signal) => ({ key, page: await listWorks(wanted, size, null, signal) }), key);
  const [later, setLater] = useState<Later | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);

  const shown = first.value;
  const busy = shown?.page.items.some((job) => job.status === 'queued' || job.status === 'running') ?? false;
  useEffect(() => {
    if (!busy) return;
    const timer = setInterval(first.reload, REFRESH_MS);
    return () => clearInterval(timer);
  }, [busy]);
  useEffect(() => setProblem(null), [key]);

  if (!shown) return { jobs: null, versions: {}, stale: false, problem: first.problem, retry: first.reload, more: null };
  const { items, versions, next_cursor } = shown.page;
  const stale = shown.key !== key;
  const rest = later?.key === shown.key ? later : null;
  const cursor = rest ? rest.next : next_cursor;
  const more = async (): Promise<void> => {
    setProblem(null);
    try {
      const page = await listWorks(wanted, size, cursor);
      setLater({
        key,
        jobs: [...(rest?.jobs ?? []), ...page.items],
        versions: { ...rest?.versions, ...page.versions },
        next: page.next_cursor,
      });
    } catch (error) {
      setProblem(asProblem(error));
    }
  };
  const known = new Set(items.map((job) => job.tree)); // a work that was revised since stands at the top
  return {
    jobs: [...items, ...(rest?.jobs ?? []).filter((job) => !known.has(job.tree))],
    versions: { ...rest?.versions, ...versions },
    stale,
    problem: problem ?? first.problem,
    retry: problem ? () => void more() : first.reload,
    more: cursor && !stale ? more : null,
  };
}

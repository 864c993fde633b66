/** A job as it changes: read once, then followed over server-sent events. */

import { useEffect, useReducer } from 'preact/hooks';
import { eventsUrl, getJob, type Job, Problem, type Progress } from '.';

export interface Followed {
  job: Job | null;
  problem: Problem | null;
  /** The stages that were seen so far, in order; the last one is running while the job is. */
  stages: string[];
  /** Whether the line to the service is broken at the moment; it mends itself. */
  interrupted: boolean;
}

export type Change =
  | { type: 'job'; job: Job }
  | { type: 'progress'; progress: Progress }
  | { type: 'interrupted' }
  | { type: 'problem'; problem: Problem };

export const nothing: Followed = { job: null, problem: null, stages: [], interrupted: false };

export const finished = (job: Job): boolean => job.status !== 'queued' && job.status !== 'running';

/** What is known after a change. */
export function follow(state: Followed, change: Change): Followed {
  switch (change.type) {
    case 'job':
      return {
        ...state,
        job: change.job,
        problem: null,
        interrupted: false,
        stages: withStages(state.stages, change.job.progress),
      };
    case 'progress':
      return {
        ...state,
        job: state.job && !finished(state.job) ? { ...state.job, progress: change.progress } : state.job,
        stages: withStages(state.stages, change.progress),
        interrupted: false,
      };
    case 'interrupted':
      return { ...state, interrupted: true };
    case 'problem':
      return { ...state, problem: change.problem };
  }
}

/** The stages with what is told of them: all in their order, or the one that goes on. */
function withStages(stages: string[], { stages: told, stage }: Progress): string[] {
  if (told && told.length >= stages.length) return told;
  return stage && !stages.includes(stage) ? [...stages, stage] : stages;
}

const RETRY_MS = 2000;
/** How often a job that waits is asked for its place in the queue. */
const QUEUE_MS = 4000;

/** Follow a job until it is finished. Where the line breaks, the browser takes up the events where it left off. */
export function useJob(id: string): Followed {
  const [state, change] = useReducer(follow, nothing);
  useEffect(() => watch(id, change), [id]);
  return state;
}

/** Tells of every change of a job; returns what ends the watch. */
function watch(id: string, change: (change: Change) => void): () => void {
  const stop = new AbortController();
  let source: EventSource | null = null;
  let retry = 0;
  let waiting = 0;
  let reading: Promise<void> | null = null;
  let stale = false;
  let lastEvent = '';

  const read = async (): Promise<void> => {
    try {
      const job = await getJob(id, stop.signal);
      change({ type: 'job', job });
      if (finished(job)) stop.abort();
      else if (!source) listen();
      clearTimeout(waiting);
      if (job.status === 'queued') waiting = window.setTimeout(reread, QUEUE_MS); // no event tells of others' ends
    } catch (error) {
      if (stop.signal.aborted) return;
      if (error instanceof Problem && error.code !== 'unreachable') change({ type: 'problem', problem: error });
      else later();
    }
  };
  /** Events come in bursts: whatever comes during a reading is covered by one more. */
  const reread = (): void => {
    stale = reading !== null;
    reading ??= read().finally(() => {
      reading = null;
      if (stale && !stop.signal.aborted) reread();
    });
  };
  const later = (): void => {
    change({ type: 'interrupted' });
    source?.close();
    source = null;
    clearTimeout(retry);
    retry = window.setTimeout(reread, RETRY_MS);
  };
  const listen = (): void => {
    source = new EventSource(eventsUrl(id, lastEvent));
    source.addEventListener('progress', (event: MessageEvent<string>) => {
      lastEvent = event.lastEventId;
      change({ type: 'progress', progress: JSON.parse(event.data) as Progress });
    });
    for (const name of ['status', 'artifact']) source.addEventListener(name, reread);
    source.onerror = () => {
      if (source?.readyState === EventSource.CLOSED) later();
      else reread(); // the stream ended, or broke and is being taken up: the job tells which
    };
  };

  stop.signal.addEventListener('abort', () => {
    source?.close();
    clearTimeout(retry);
    clearTimeout(waiting);
  });
  reread();
  return () => stop.abort();
}

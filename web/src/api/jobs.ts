/** Jobs: ordered, looked at, made again; and the kinds of them that the service has. */

import { aborted, answer, type Schemas, service } from './client';

export type Status = Schemas['Status'];
export type Progress = Schemas['Progress'];
export type Artifact = Schemas['ArtifactOut'];
export type Failure = Schemas['JobError'];
export type Job = Schemas['JobOut'];
/** A kind of job as the service describes it: enough to draw a form. */
export type KindDescription = Schemas['KindOut'];
export type InputDescription = Schemas['InputOut'];
export type JobList = Schemas['JobPage'];

const job = (id: string) => ({ path: { job_id: id } });

export const getJob = (id: string, signal?: AbortSignal): Promise<Job> =>
  answer(service.GET('/v1/jobs/{job_id}', { params: job(id), ...aborted(signal) }));

const jobPath = (id: string): string => `/v1/jobs/${encodeURIComponent(id)}`;

/** Where a job's events come from: all of them, or those after one that was seen. */
export const eventsUrl = (id: string, after: string): string =>
  `${jobPath(id)}/events${after && `?after=${encodeURIComponent(after)}`}`;

/** Where all results of a job are as one zip. */
export const archiveUrl = (id: string): string => `${jobPath(id)}/archive`;

export const cancelJob = (id: string): Promise<Job> =>
  answer(service.POST('/v1/jobs/{job_id}/cancel', { params: job(id) }));

/** Give a work a title, in all its versions; null takes it away. */
export const renameWork = (id: string, title: string | null): Promise<Job> =>
  answer(service.PATCH('/v1/jobs/{job_id}', { params: job(id), body: { title } }));

export async function deleteJob(id: string): Promise<void> {
  await answer(service.DELETE('/v1/jobs/{job_id}', { params: job(id) }));
}

/** One of a job's artifacts that is JSON; null where it has none of that name. */
export async function readArtifact<T>(of: Pick<Job, 'artifacts'>, name: string, signal?: AbortSignal): Promise<T | null> {
  const url = of.artifacts[name]?.url;
  if (!url) return null;
  const response = fetch(url, aborted(signal));
  return answer(
    response.then(async (got) => {
      const document = (await got.json()) as T;
      return got.ok ? { data: document, response: got } : { error: document, response: got };
    }),
  );
}

/** What the service is asked for; `metadata` holds the names that this page gives it. */
export interface JobRequest {
  inputs: Record<string, string | string[]>;
  options: object;
  metadata: Record<string, string>;
}

/** Order something. A key makes the order safe to repeat: it is carried out once. */
export const createJob = (body: { kind: string } & JobRequest, key: string): Promise<Job> =>
  answer(
    service.POST('/v1/jobs', { params: { header: { 'idempotency-key': key } }, body: body as Schemas['JobIn'] }),
  );

/** What is to be different about a job that is made again; null takes something back to what it is by itself. */
export interface Changes {
  options?: object;
  corrections?: object;
  metadata?: Job['metadata'];
}

/** A job again, with something put right or otherwise. A key makes it safe to repeat. */
export const reviseJob = (id: string, changes: Changes, key: string): Promise<Job> =>
  answer(
    service.POST('/v1/jobs/{job_id}/revisions', {
      params: { ...job(id), header: { 'idempotency-key': key } },
      body: changes as Schemas['RevisionIn'],
    }),
  );

/** The kinds of jobs that the service has. */
export const listKinds = async (signal?: AbortSignal): Promise<KindDescription[]> =>
  (await answer(service.GET('/v1/kinds', aborted(signal)))).items;

/** A job and all that was made of it, oldest first. */
export const listRevisions = async (id: string, signal?: AbortSignal): Promise<Job[]> =>
  (await answer(service.GET('/v1/jobs/{job_id}/revisions', { params: job(id), ...aborted(signal) }))).items;

/** Which jobs are wanted: of these kinds, of one status or all, found by these words. */
export interface Wanted {
  kinds: readonly string[];
  status: Status | null;
  words: string;
}

/** Of each work the newest job that is wanted, newest first: the latest, or those that come after a cursor. */
export const listWorks = (
  { kinds, status, words }: Wanted,
  size: number,
  cursor: string | null,
  signal?: AbortSignal,
): Promise<JobList> =>
  answer(
    service.GET('/v1/jobs', {
      params: {
        query: {
          ...{ limit: size, kind: [...kinds], latest: true },
          ...(status && { status: [status] }),
          ...(words && { q: words }),
          ...(cursor && { cursor }),
        },
      },
      ...aborted(signal),
    }),
  );

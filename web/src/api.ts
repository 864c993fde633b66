/** The service's HTTP API, as far as this page uses it. */

export type Status = 'queued' | 'running' | 'succeeded' | 'failed' | 'canceled';

export interface Progress {
  stage: string | null;
  fraction: number;
  message: string;
  eta_seconds: number | null;
}

export interface Artifact {
  url: string;
  size: number;
  sha256: string;
  content_type: string;
}

export interface Failure {
  code: string;
  detail: string;
}

export interface PortraitOptions {
  strength?: number;
  follow?: Part[];
  sound?: boolean;
  trim?: [number, number] | null;
}

export type Part = 'eyes' | 'mouth' | 'brows' | 'head';

export interface Job {
  id: string;
  kind: string;
  status: Status;
  progress: Progress;
  inputs: Record<string, string | string[]>;
  options: PortraitOptions & Record<string, unknown>;
  artifacts: Record<string, Artifact>;
  error: Failure | null;
  metadata: Record<string, unknown>;
  created_at: string;
  started_at: string | null;
  finished_at: string | null;
}

/** What a finished run says about itself; only what this page reads. */
export interface Report {
  warnings: { code: string; message: string }[];
}

/** An answer of the service that is not a success, or no answer at all (`unreachable`). */
export class Problem extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    readonly detail: string,
  ) {
    super(`${code}: ${detail}`);
  }
}

/** The problem that a response's body describes (RFC 9457), whatever its form. */
export function problemFrom(status: number, body: string): Problem {
  try {
    const document = JSON.parse(body) as Partial<Failure>;
    if (document.code && document.detail) return new Problem(status, document.code, document.detail);
  } catch {
    // A proxy in between may answer in HTML: its status is all there is to tell.
  }
  return new Problem(status, `http_${status}`, '');
}

async function request(path: string, init: RequestInit = {}): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, init);
  } catch (cause) {
    if (cause instanceof DOMException && cause.name === 'AbortError') throw cause;
    throw new Problem(0, 'unreachable', '');
  }
  if (!response.ok) throw problemFrom(response.status, await response.text());
  return response;
}

async function get<T>(path: string, signal?: AbortSignal): Promise<T> {
  const response = await request(path, signal ? { signal } : {});
  return (await response.json()) as T;
}

const jobPath = (id: string): string => `/v1/jobs/${encodeURIComponent(id)}`;

export const getJob = (id: string, signal?: AbortSignal): Promise<Job> => get(jobPath(id), signal);
/** Where a job's events come from: all of them, or those after one that was seen. */
export const eventsUrl = (id: string, after: string): string =>
  `${jobPath(id)}/events${after && `?after=${encodeURIComponent(after)}`}`;

export async function cancelJob(id: string): Promise<void> {
  await request(`${jobPath(id)}/cancel`, { method: 'POST' });
}

export async function deleteJob(id: string): Promise<void> {
  await request(jobPath(id), { method: 'DELETE' });
}

/** A finished job's report. */
export const getReport = (job: Job, signal?: AbortSignal): Promise<Report> => {
  const artifact = job.artifacts['report.json'];
  return artifact ? get(artifact.url, signal) : Promise.resolve({ warnings: [] });
};

/** Order a portrait. A key makes the order safe to repeat: it is carried out once. */
export async function createPortrait(
  inputs: { image: string; driver: string },
  options: PortraitOptions,
  metadata: Record<string, string>,
  key: string,
): Promise<Job> {
  const response = await request('/v1/jobs', {
    method: 'POST',
    headers: { 'Content-Type': 'application/json', 'Idempotency-Key': key },
    body: JSON.stringify({ kind: 'portrait', inputs, options, metadata }),
  });
  return (await response.json()) as Job;
}

export interface JobPage {
  items: Job[];
  next_cursor: string | null;
}

/** The latest jobs, or those that come after a cursor. */
export const listJobs = (cursor: string | null, signal?: AbortSignal): Promise<JobPage> =>
  get(`/v1/jobs?limit=12${cursor ? `&cursor=${encodeURIComponent(cursor)}` : ''}`, signal);

/** A performance that a portrait can act out by name. */
export interface Driver {
  name: string;
  source: 'built-in' | 'own';
  /** What it shows, in a few words. */
  title?: string | null;
  url: string;
}

export const listDrivers = async (signal?: AbortSignal): Promise<Driver[]> =>
  (await get<{ items: Driver[] }>('/v1/drivers', signal)).items;

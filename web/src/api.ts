/** The service's HTTP API, as far as this page uses it; its types come from the service's own description. */

import createClient from 'openapi-fetch';
import { randomKey } from './key';
import type { CharacterOptions, MotionDetails, Skeleton } from './kinds/character/types';
import type { Landmarks, PortraitOptions } from './kinds/portrait/types';
import type { components, paths } from './openapi';
import type { Frame, Report } from './report';
import { tellLocked } from './session';

export type * from './kinds/character/types';
export type * from './kinds/portrait/types';
export type * from './report';

type Schemas = components['schemas'];
export type Status = Schemas['Status'];
export type Progress = Schemas['Progress'];
export type Artifact = Schemas['ArtifactOut'];
export type Failure = Schemas['JobError'];
export type Job = Schemas['JobOut'];
/** A kind of job as the service describes it: enough to draw a form. */
export type KindDescription = Schemas['KindOut'];
export type InputDescription = Schemas['InputOut'];
export type JobPage = Schemas['JobPage'];
/** A performance that a portrait can act out by name. */
export type Driver = Schemas['DriverOut'];
/** A motion that a character can do by name. */
export type KeptMotion = Schemas['MotionOut'];
/** A segment of one's own driver that holds an emotion or a gesture. */
export type Moment = Schemas['MomentOut'];
export type PublicLink = Schemas['LinkOut'];
export type Shared = Schemas['SharedOut'];
export type Key = Schemas['KeyOut'];
export type NewKey = Schemas['NewKeyOut'];
export type OwnKey = Schemas['OwnKeyOut'];
export type Webhook = Schemas['WebhookOut'];
export type NewWebhook = Schemas['NewWebhookOut'];
export type WebhookEvent = Schemas['EventType'];
export type WebhookSecret = Schemas['SecretOut'];
export type Delivery = Schemas['DeliveryOut'];
export type DeliveryDetail = Schemas['DeliveryDetail'];

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
    return problemOf(status, JSON.parse(body));
  } catch {
    return problemOf(status, null);
  }
}

function problemOf(status: number, document: unknown): Problem {
  const { code, detail } = (document ?? {}) as Partial<Schemas['ProblemDocument']>;
  // A proxy in between may answer in HTML: its status is all there is to tell.
  return code && detail ? new Problem(status, code, detail) : new Problem(status, `http_${status}`, '');
}

const service = createClient<paths>();

interface Answer<T> {
  data?: T;
  error?: unknown;
  response: Response;
}

/** What the service answered; a `Problem` is thrown for everything but success. */
async function answer<T>(request: Promise<Answer<T>>): Promise<T> {
  let reply: Answer<T>;
  try {
    reply = await request;
  } catch (cause) {
    if (cause instanceof DOMException && cause.name === 'AbortError') throw cause;
    throw new Problem(0, 'unreachable', '');
  }
  const { data, error, response } = reply;
  if (response.status === 401) tellLocked();
  if (!response.ok) throw problemOf(response.status, error);
  return data as T;
}

const aborted = (signal: AbortSignal | undefined) => (signal ? { signal } : {});
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

/** What a portrait was made with. */
export const portraitOptions = (of: Job): PortraitOptions => of.options as PortraitOptions;

/** What a character was made with. */
export const characterOptions = (of: Job): CharacterOptions => of.options as CharacterOptions;

/** The boxes of the people that a failed job has found. */
export const foundPeople = (of: Job): Frame[] => (of.error?.found as { people?: Frame[] } | undefined)?.people ?? [];

/** The boxes of the faces that a failed job has found, to choose another from. */
export const foundFaces = (of: Job): Report['inputs']['faces'] =>
  (of.error?.found as { faces?: Report['inputs']['faces'] } | undefined)?.faces ?? [];

/** One of a job's artifacts that is JSON; null where it has none of that name. */
async function artifact<T>(of: Pick<Job, 'artifacts'>, name: string, signal?: AbortSignal): Promise<T | null> {
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

/** A finished job's report; null where the job left none. */
export const getReport = (of: Job, signal?: AbortSignal): Promise<Report | null> => artifact(of, 'report.json', signal);

/** The landmarks of a job that succeeded; null where it left none. */
export const getLandmarks = (of: Job, signal?: AbortSignal): Promise<Landmarks | null> =>
  artifact(of, 'landmarks.json', signal);

/** The skeleton of a character; null where its job left none. */
export const getSkeleton = (of: Pick<Job, 'artifacts'>, signal?: AbortSignal): Promise<Skeleton | null> =>
  artifact(of, 'skeleton.json', signal);

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
): Promise<JobPage> =>
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

export const listDrivers = async (signal?: AbortSignal): Promise<Driver[]> =>
  (await answer(service.GET('/v1/drivers', aborted(signal)))).items;

/** All motions that a job can name. */
export const listMotions = async (signal?: AbortSignal): Promise<KeptMotion[]> =>
  (await answer(service.GET('/v1/motions', aborted(signal)))).items;

/** The motions that the service keeps for the user. */
export const listOwnMotions = async (signal?: AbortSignal): Promise<KeptMotion[]> =>
  (await listMotions(signal)).filter(({ source }) => source === 'own');

/** Whether a motion can move somebody, if need be once its joints are told. */
export const canMove = ({ check_status, error, missing }: KeptMotion): boolean =>
  check_status === 'ready' && (!error || (missing?.length ?? 0) > 0);

const kept = (name: string) => ({ path: { name } });

export const renameMotion = (name: string, wanted: string): Promise<KeptMotion> =>
  answer(service.PATCH('/v1/motions/{name}', { params: kept(name), body: { name: wanted } }));

export async function deleteMotion(name: string): Promise<void> {
  await answer(service.DELETE('/v1/motions/{name}', { params: kept(name) }));
}

/** What is known of a motion that the service keeps. */
export const getMotion = (name: string, signal?: AbortSignal): Promise<KeptMotion> =>
  answer(service.GET('/v1/motions/{name}', { params: kept(name), ...aborted(signal) }));

/** Have the service look into a motion file: one that it has, or one at hand, which it keeps no longer than the job. */
export function orderMotionCheck(motion: string | File): Promise<Job> {
  const header = { 'idempotency-key': randomKey() };
  const body = { kind: 'motion' as const, inputs: { motion: motion as string } };
  if (typeof motion === 'string') return answer(service.POST('/v1/jobs', { params: { header }, body }));
  const form = new FormData();
  form.append('kind', body.kind);
  form.append('motion', motion);
  return answer(service.POST('/v1/jobs', { params: { header }, body, bodySerializer: () => form }));
}

/** What such a look has found. */
export const getMotionDetails = (of: Job, signal?: AbortSignal): Promise<MotionDetails | null> =>
  artifact(of, 'motion.json', signal);

/** Keep an uploaded video as a driver of one's own; it is searched for moments then. */
export const createDriver = (name: string, file: string): Promise<Driver> =>
  answer(service.POST('/v1/drivers', { body: { name, file } }));

export const renameDriver = (name: string, wanted: string): Promise<Driver> =>
  answer(service.PATCH('/v1/drivers/{name}', { params: kept(name), body: { name: wanted } }));

export async function deleteDriver(name: string): Promise<void> {
  await answer(service.DELETE('/v1/drivers/{name}', { params: kept(name) }));
}

/** The public links to a job, oldest first. */
export const listLinks = async (id: string, signal?: AbortSignal): Promise<PublicLink[]> =>
  (await answer(service.GET('/v1/jobs/{job_id}/links', { params: job(id), ...aborted(signal) }))).items;

/** Open some artifacts of a job, or all, to whoever knows the link; for some hours, or until it is revoked. */
export const createLink = (id: string, hours: number | null, artifacts: string[] | null): Promise<PublicLink> =>
  answer(
    service.POST('/v1/jobs/{job_id}/links', { params: job(id), body: { expires_in_hours: hours, artifacts } }),
  );

export async function revokeLink(id: string): Promise<void> {
  await answer(service.DELETE('/v1/links/{link_id}', { params: { path: { link_id: id } } }));
}

/** What a public link opens. */
export const getShared = (token: string, signal?: AbortSignal): Promise<Shared> =>
  answer(service.GET('/v1/public/{token}', { params: { path: { token } }, ...aborted(signal) }));

/** Give a key once; a cookie stands for it then. */
export async function openSession(key: string): Promise<void> {
  await answer(service.POST('/v1/session', { body: { key } }));
}

export async function closeSession(): Promise<void> {
  await answer(service.DELETE('/v1/session'));
}

export const getOwnKey = (signal?: AbortSignal): Promise<OwnKey> => answer(service.GET('/v1/key', aborted(signal)));

export const listKeys = async (signal?: AbortSignal): Promise<Key[]> =>
  (await answer(service.GET('/v1/keys', aborted(signal)))).items;

export const createKey = (name: string, scopes: ('read' | 'submit' | 'admin')[], days: number | null): Promise<NewKey> =>
  answer(service.POST('/v1/keys', { body: { name, scopes, expires_in_days: days } }));

export async function revokeKey(id: string): Promise<void> {
  await answer(service.DELETE('/v1/keys/{key_id}', { params: { path: { key_id: id } } }));
}

const webhook = (id: string) => ({ path: { webhook_id: id } });
const delivery = (id: string) => ({ path: { delivery_id: id } });

export const listWebhooks = async (signal?: AbortSignal): Promise<Webhook[]> =>
  (await answer(service.GET('/v1/webhooks', aborted(signal)))).items;

/** Have an address told of jobs. The answer holds the secret that signs the messages. */
export const createWebhook = (url: string, events: WebhookEvent[]): Promise<NewWebhook> =>
  answer(service.POST('/v1/webhooks', { body: { url, events } }));

export const enableWebhook = (id: string, enabled: boolean): Promise<Webhook> =>
  answer(service.PATCH('/v1/webhooks/{webhook_id}', { params: webhook(id), body: { enabled } }));

export async function deleteWebhook(id: string): Promise<void> {
  await answer(service.DELETE('/v1/webhooks/{webhook_id}', { params: webhook(id) }));
}

export const getWebhookSecret = (id: string): Promise<WebhookSecret> =>
  answer(service.GET('/v1/webhooks/{webhook_id}/secret', { params: webhook(id) }));

/** A new secret; the old one signs beside it for a day. */
export const rotateWebhookSecret = (id: string): Promise<WebhookSecret> =>
  answer(service.POST('/v1/webhooks/{webhook_id}/secret/rotate', { params: webhook(id) }));

export const testWebhook = (id: string): Promise<Delivery> =>
  answer(service.POST('/v1/webhooks/{webhook_id}/test', { params: webhook(id) }));

/** What was told, newest first: the latest, or what comes after a cursor. */
export const listDeliveries = (cursor: string | null, signal?: AbortSignal): Promise<Schemas['DeliveryPage']> =>
  answer(
    service.GET('/v1/webhooks/deliveries', {
      params: { query: { limit: 20, ...(cursor && { cursor }) } },
      ...aborted(signal),
    }),
  );

export const getDelivery = (id: string, signal?: AbortSignal): Promise<DeliveryDetail> =>
  answer(service.GET('/v1/webhooks/deliveries/{delivery_id}', { params: delivery(id), ...aborted(signal) }));

export const replayDelivery = (id: string): Promise<Delivery> =>
  answer(service.POST('/v1/webhooks/deliveries/{delivery_id}/replay', { params: delivery(id) }));

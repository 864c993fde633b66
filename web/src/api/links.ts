/** Public links to what a job made. */

import { aborted, answer, type Schemas, service } from './client';

export type PublicLink = Schemas['LinkOut'];
export type Shared = Schemas['SharedOut'];

const job = (id: string) => ({ path: { job_id: id } });

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

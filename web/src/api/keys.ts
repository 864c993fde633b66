/** Keys: the visitor's own, and, for whoever may manage them, all. */

import { aborted, answer, type Schemas, service } from './client';

export type Key = Schemas['KeyOut'];
export type NewKey = Schemas['NewKeyOut'];
export type OwnKey = Schemas['OwnKeyOut'];

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

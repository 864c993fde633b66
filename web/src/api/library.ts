/** Drivers and motions that jobs can name: the built-in ones, and those that the service keeps for the user. */

import { aborted, answer, type Schemas, service } from './client';
import { randomKey } from './idempotency';
import type { Job } from './jobs';

/** A performance that a portrait can act out by name. */
export type Driver = Schemas['DriverOut'];
/** A motion that a character can do by name. */
export type KeptMotion = Schemas['MotionOut'];
/** A segment of one's own driver that holds an emotion or a gesture. */
export type Moment = Schemas['MomentOut'];

const kept = (name: string) => ({ path: { name } });

export const listDrivers = async (signal?: AbortSignal): Promise<Driver[]> =>
  (await answer(service.GET('/v1/drivers', aborted(signal)))).items;

/** All motions that a job can name. */
export const listMotions = async (signal?: AbortSignal): Promise<KeptMotion[]> =>
  (await answer(service.GET('/v1/motions', aborted(signal)))).items;

/** The motions that the service keeps for the user. */
export const listOwnMotions = async (signal?: AbortSignal): Promise<KeptMotion[]> =>
  (await listMotions(signal)).filter(({ source }) => source === 'own');

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

/** Keep an uploaded video as a driver of one's own; it is searched for moments then. */
export const createDriver = (name: string, file: string): Promise<Driver> =>
  answer(service.POST('/v1/drivers', { body: { name, file } }));

export const renameDriver = (name: string, wanted: string): Promise<Driver> =>
  answer(service.PATCH('/v1/drivers/{name}', { params: kept(name), body: { name: wanted } }));

export async function deleteDriver(name: string): Promise<void> {
  await answer(service.DELETE('/v1/drivers/{name}', { params: kept(name) }));
}

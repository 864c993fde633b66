/** Jobs of a service, ordered and awaited as any other client would. */

import { expect } from 'vitest';
import { fileOf } from './media';

/** Milliseconds: a job's time on a machine that has other work as well. */
export const LONG = 900_000;

/** Milliseconds: the same where what makes the job is compiled first, as it is for kinds that are not in `finished_jobs`. */
export const LONG_WITH_COMPILING = 1_200_000;

/** Orders a job; its id. */
export async function submit(
  address: string,
  kind: string,
  inputs: Record<string, File | string>,
  options: object,
): Promise<string> {
  const body = new FormData();
  body.append('kind', kind);
  for (const [name, value] of Object.entries(inputs)) body.append(name, value);
  body.append('options', JSON.stringify(options));
  const response = await fetch(`${address}/v1/jobs`, { method: 'POST', body });
  expect(response.status, await response.clone().text()).toBe(202);
  return ((await response.json()) as { id: string }).id;
}

/** Orders a portrait; without a driver where that is null. */
export const orderPortrait = (
  address: string,
  image: string,
  driver: string | File | null,
  options: object = {},
): Promise<string> => submit(address, 'portrait', { image: fileOf(image), ...(driver !== null && { driver }) }, options);

/** Options of a portrait that is soon made. */
export const SMALL = { size: [240, 300] };

/** Options of a character that is soon made, and soon drawn where there is no graphics card. */
export const LIGHT = { seconds: 1, size: [240, 320], triangles: 10_000 };

/** Orders a character. */
export const orderCharacter = (address: string, photo: string, options: object = {}): Promise<string> =>
  submit(address, 'character', { photo: fileOf(photo) }, options);

/** Makes a finished job again with other options; the id of the job that does. */
export async function revise(address: string, job: string, options: object): Promise<string> {
  const response = await fetch(`${address}/v1/jobs/${job}/revisions`, {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ options }),
  });
  expect(response.status, await response.clone().text()).toBe(202);
  return ((await response.json()) as { id: string }).id;
}

/** Waits until a job has ended so, and in no other way; `patience` in milliseconds. */
export async function ended(address: string, job: string, so: 'succeeded' | 'failed' = 'succeeded', patience = LONG): Promise<void> {
  const deadline = Date.now() + patience;
  for (let status = ''; status !== so; await new Promise((wake) => setTimeout(wake, 250))) {
    const told = (await (await fetch(`${address}/v1/jobs/${job}`)).json()) as { status: string; error: object | null };
    status = told.status;
    if ((/succeeded|failed/.test(status) && status !== so) || Date.now() > deadline) {
      throw new Error(`the job ${job} is ${status}: ${JSON.stringify(told.error)}`);
    }
  }
}

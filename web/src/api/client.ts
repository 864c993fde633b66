/** Requests to the service, and its problems; the types come from the service's own description. */

import createClient from 'openapi-fetch';
import type { components, paths } from './openapi';
import { tellLocked } from './session';

export type Schemas = components['schemas'];

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

export const service = createClient<paths>();

interface Answer<T> {
  data?: T;
  error?: unknown;
  response: Response;
}

/** What the service answered; a `Problem` is thrown for everything but success. */
export async function answer<T>(request: Promise<Answer<T>>): Promise<T> {
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

/** The signal that ends a request, where there is one, as the client takes it. */
export const aborted = (signal: AbortSignal | undefined) => (signal ? { signal } : {});

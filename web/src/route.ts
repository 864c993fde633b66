/** Which page an address means. The part after `#` never reaches a server, so links work wherever the page lies. */

import { useEffect, useState } from 'preact/hooks';
import type { Status } from './api';

export type Route =
  | { page: 'studio' }
  | { page: 'character' }
  | { page: 'job'; id: string }
  | { page: 'history'; status: Status | null }
  | { page: 'shared'; token: string }
  | { page: 'keys' }
  | { page: 'webhooks' }
  /** An address that means nothing. */
  | { page: 'lost' };

export const statuses: readonly Status[] = ['succeeded', 'running', 'queued', 'failed', 'canceled'];

/** The page at `path` that `hash` names. */
export function parseRoute(hash: string, path = '/'): Route {
  if (path !== '/' && path !== '/index.html') return { page: 'lost' };
  if (!hash.startsWith('#/') || hash === studioLink) return { page: 'studio' };
  const [, place = '', rest, beyond] = /^#\/([a-z]*)(?:\/([^/?#]+))?(.*)$/.exec(hash) ?? [];
  const given = rest && !beyond ? decoded(rest) : null;
  if (place === 'jobs' && given) return { page: 'job', id: given };
  if (place === 'shared' && given) return { page: 'shared', token: given };
  if (place === 'history' && (!rest || !beyond)) {
    return { page: 'history', status: statuses.find((status) => status === given) ?? null };
  }
  if ((place === 'character' || place === 'keys' || place === 'webhooks') && !rest && !beyond) return { page: place };
  return { page: 'lost' };
}

/** Null where a link was cut off, or damaged by what it was sent through. */
function decoded(part: string): string | null {
  try {
    return decodeURIComponent(part);
  } catch {
    return null;
  }
}

export const jobLink = (id: string): string => `#/jobs/${encodeURIComponent(id)}`;
export const historyLink = (status: Status | null): string => (status ? `#/history/${status}` : '#/history');
export const studioLink = '#/';
export const characterLink = '#/character';
export const keysLink = '#/keys';
export const webhooksLink = '#/webhooks';

export function useRoute(): Route {
  const [route, setRoute] = useState(() => parseRoute(location.hash, location.pathname));
  useEffect(() => {
    const follow = (): void => setRoute(parseRoute(location.hash, location.pathname));
    addEventListener('hashchange', follow);
    return () => removeEventListener('hashchange', follow);
  }, []);
  return route;
}

/** Which page an address means. The part after `#` never reaches a server, so links work wherever the page lies. */

import { useLayoutEffect, useState } from 'preact/hooks';
import type { Status } from './api';
import type { Kind } from './kind/kind';

export type Route =
  /** Where something of a kind is ordered. */
  | { page: 'studio'; kind: string }
  | { page: 'job'; id: string }
  | { page: 'history'; status: Status | null; words: string }
  | { page: 'shared'; token: string }
  /** A live portrait alone, for whoever has the token. */
  | { page: 'live'; id: string; token: string }
  | { page: 'keys' }
  | { page: 'webhooks' }
  /** An address that means nothing. */
  | { page: 'lost' };

export const statuses: readonly Status[] = ['succeeded', 'running', 'queued', 'failed', 'canceled'];

/** Characters of a search, at most. */
export const MAX_SEARCH_CHARACTERS = 200;

/** The start page: the studio of the first kind. */
export const studioLink = '#/';

/** The page at `path` that `hash` names; these kinds have studios under addresses of their own. */
export function parseRoute(kinds: readonly Kind[], hash: string, path = '/'): Route {
  if (path !== '/' && path !== '/index.html') return { page: 'lost' };
  const isStart = hash === studioLink || !hash.startsWith('#/');
  const kind = isStart ? kinds[0] : kinds.find(({ link }) => link === hash);
  if (kind) return { page: 'studio', kind: kind.name };
  const [, place = '', rest, beyond = ''] = /^#\/([a-z]*)(?:\/([^/?#]+))?(.*)$/.exec(hash) ?? [];
  const given = rest && !beyond ? decoded(rest) : null;
  if (place === 'make' && given) return { page: 'studio', kind: given };
  if (place === 'jobs' && given) return { page: 'job', id: given };
  if (place === 'shared' && given) return { page: 'shared', token: given };
  if (place === 'live' && rest && /^\/[^/?#]+$/.test(beyond)) {
    const [id, token] = [decoded(rest), decoded(beyond.slice(1))];
    if (id && token) return { page: 'live', id, token };
  }
  if (place === 'history' && (!rest || !beyond || beyond.startsWith('?'))) {
    const status = rest ? decoded(rest) : null;
    const words = (new URLSearchParams(beyond.replace(/^.*\?/, '')).get('q') ?? '').trim().slice(0, MAX_SEARCH_CHARACTERS);
    return { page: 'history', status: statuses.find((one) => one === status) ?? null, words };
  }
  if ((place === 'keys' || place === 'webhooks') && !rest && !beyond) return { page: place };
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
export const historyLink = (status: Status | null, words = ''): string =>
  `#/history${status ? `/${status}` : ''}${words && `?q=${encodeURIComponent(words)}`}`;
export const keysLink = '#/keys';
export const webhooksLink = '#/webhooks';

/** Have the address name this, without a step more in the browser's history. */
export function replaceAddress(hash: string): void {
  history.replaceState(history.state, '', hash);
  dispatchEvent(new HashChangeEvent('hashchange'));
}

export function useRoute(kinds: readonly Kind[]): Route {
  const [route, setRoute] = useState(() => parseRoute(kinds, location.hash, location.pathname));
  // at once, not after the first picture: an address that changed in between would be missed for good
  useLayoutEffect(() => {
    const follow = (): void => setRoute(parseRoute(kinds, location.hash, location.pathname));
    addEventListener('hashchange', follow);
    return () => removeEventListener('hashchange', follow);
  }, []);
  return route;
}

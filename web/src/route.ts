/** Which page an address means. The part after `#` never reaches a server, so links work wherever the page lies. */

import { useEffect, useState } from 'preact/hooks';

export type Route = { page: 'studio' } | { page: 'job'; id: string };

export function parseRoute(hash: string): Route {
  const id = /^#\/jobs\/([^/?#]+)$/.exec(hash)?.[1];
  return id ? { page: 'job', id: decodeURIComponent(id) } : { page: 'studio' };
}

export const jobLink = (id: string): string => `#/jobs/${encodeURIComponent(id)}`;
export const studioLink = '#/';

export function useRoute(): Route {
  const [route, setRoute] = useState(() => parseRoute(location.hash));
  useEffect(() => {
    const follow = (): void => setRoute(parseRoute(location.hash));
    addEventListener('hashchange', follow);
    return () => removeEventListener('hashchange', follow);
  }, []);
  return route;
}

/** The viewer, fetched when somebody is first shown. */

import { later, preload } from '../widgets/lazy';

const load = () => import('./panel');

export const Viewer = later(load);

/** Fetch it with what it stands in: it is higher than all else there. Where it does not come, it says so in its place. */
export const withViewer = async <Part>(part: Promise<Part>): Promise<Part> => {
  const [loaded] = await Promise.all([part, preload(load).catch(() => null)]);
  return loaded;
};

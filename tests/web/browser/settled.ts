/** What is read of a page that may still be moving. */

import { PATIENCE } from './browser';

/**
 * What is read, once two readings agree that are so many milliseconds apart. For what no event tells the end of: a layout,
 * a drawing, a count. What is to have changed has to be waited for beforehand.
 */
export async function settled<Of>(read: () => Promise<Of>, apart = 300): Promise<Of> {
  const deadline = Date.now() + PATIENCE;
  for (let before = JSON.stringify(await read()); Date.now() < deadline; ) {
    await new Promise((wake) => setTimeout(wake, apart));
    const now = await read();
    const said = JSON.stringify(now);
    if (said === before) return now;
    before = said;
  }
  throw new Error(`it did not come to rest: ${read}`);
}

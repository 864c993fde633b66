/**
 * A page that is slow at every turn, for whoever writes a test: `GALATEA_TESTS_SHAKEN=1 npm run browser -- axe`. What is
 * read before it is waited for fails then at once, and not once in fifty runs on a busy machine.
 */

import type { Page } from 'playwright-core';

/** Which way it is shaken, a whole number; 0 is not at all. */
const seed = Number(process.env.GALATEA_TESTS_SHAKEN ?? 0);

const LONGEST = 700; // milliseconds that a request is held back
const SLOWER = 6; // times that scripts of the page take

/** Holds every request of a page back, each address for another time, and slows its scripts down. */
export async function shake(page: Page): Promise<void> {
  if (!seed) return;
  let asked = seed;
  await page.context().route('**/*', async (route) => {
    await new Promise((wake) => setTimeout(wake, scattered(route.request().url(), asked++) * LONGEST));
    await route.continue().catch(() => undefined); // the page may be gone meanwhile
  });
  const devtools = await page.context().newCDPSession(page);
  await devtools.send('Emulation.setCPUThrottlingRate', { rate: SLOWER });
}

/** A share in [0, 1) that is as good as random, and the same whenever it is asked for (FNV-1a). */
function scattered(text: string, salt: number): number {
  let hash = 0x811c9dc5;
  for (const letter of `${salt} ${text}`) hash = Math.imul(hash ^ letter.codePointAt(0)!, 0x01000193) >>> 0;
  return hash / 2 ** 32;
}

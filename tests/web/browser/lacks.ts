/** That something is not on a page. */

import type { Locator } from 'playwright-core';
import { expect } from 'vitest';

/**
 * Holds that a page has nothing like this. A page that is not drawn yet has nothing at all: so this waits first for what
 * stands `beside` it, which has to come in the same drawing or after it.
 */
export async function lacks(absent: Locator, beside: Locator): Promise<void> {
  await beside.first().waitFor({ state: 'attached' });
  await expect.poll(() => absent.count(), { message: `how many there are of ${absent}` }).toBe(0);
}

/** Whether everybody can read and use a page: axe's rules, and nothing that runs out of the window. */

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import type { Page } from 'playwright-core';
import { expect } from 'vitest';

// A browser loads it into the page: the source, not the module.
const axe = readFileSync(createRequire(new URL('../../../web/package.json', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8');

/** Looks at a page as it stands: wide, light and dark, and on a phone. */
export async function readable(page: Page): Promise<void> {
  await page.evaluate(axe);
  const found = new Map<string, string[]>();
  for (const [width, colorScheme, runOnly] of [
    [1280, 'light', []],
    [1280, 'dark', ['color-contrast']], // nothing else of a page is another in the dark
    [320, 'dark', []],
  ] as const) {
    await page.setViewportSize({ width, height: 800 });
    await page.emulateMedia({ colorScheme, reducedMotion: 'reduce' });
    const results = await page.evaluate(
      (rules) => (window as unknown as { axe: typeof import('axe-core') }).axe.run(rules.length > 0 ? { runOnly: [...rules] } : {}),
      runOnly,
    );
    for (const { id, impact, nodes } of results.violations) {
      if (impact === 'serious' || impact === 'critical' || id === 'heading-order') {
        found.set(`${id} at ${width} ${colorScheme}`, nodes.map((node) => `${node.html} ${node.any[0]?.message ?? ''}`));
      }
    }
    const overflow = () => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    await expect.poll(overflow, { message: `pixels beyond ${width}` }).toBeLessThanOrEqual(0);
  }
  expect(Object.fromEntries(found)).toEqual({});
}

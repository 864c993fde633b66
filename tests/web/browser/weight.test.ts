import { gzipSync } from 'node:zlib';
import { expect, inject, it } from 'vitest';
import { launch, open } from './page';

const BUDGET = 200_000;

it('is there at the first load with less than 200 kB', async () => {
  const browser = await launch();
  try {
    const page = await open(browser);
    await page.getByRole('radio').first().waitFor({ state: 'attached' });
    const loaded = await page.evaluate(() =>
      performance
        .getEntriesByType('resource')
        .map((entry) => entry as PerformanceResourceTiming)
        .filter(({ initiatorType }) => ['script', 'link', 'css', 'other'].includes(initiatorType))
        .map(({ name }) => name),
    );
    const ours = [`${inject('address')}/`, ...loaded.filter((name) => /\.(js|css|svg)$/.test(name))];
    expect(ours.length).toBeGreaterThan(3);
    const sizes = await Promise.all(
      ours.map(async (url) => gzipSync(Buffer.from(await (await fetch(url)).arrayBuffer())).length),
    );
    expect(sizes.reduce((sum, size) => sum + size, 0)).toBeLessThan(BUDGET);
    for (const part of ['editor', 'recorder', 'keys', 'webhooks', 'character', 'motions', 'joints', 'painter']) {
      expect(ours.some((url) => url.includes(`/${part}-`)), `${part} is fetched when it is needed`).toBe(false);
    }
  } finally {
    await browser.close();
  }
});

import { gzipSync } from 'node:zlib';
import { expect, it } from 'vitest';
import { launch } from './browser';
import { LONG } from './jobs';
import { portrait } from './media';
import { address } from './own_service';
import { ask, open, order } from './page';

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
    const ours = [`${address}/`, ...loaded.filter((name) => /\.(js|css|svg)$/.test(name))];
    expect(ours.length).toBeGreaterThan(3);
    const sizes = await Promise.all(
      ours.map(async (url) => gzipSync(Buffer.from(await (await fetch(url)).arrayBuffer())).length),
    );
    expect(sizes.reduce((sum, size) => sum + size, 0)).toBeLessThan(BUDGET);
    for (const part of ['editor', 'recorder', 'keys', 'webhooks', 'panel', 'result', 'model', 'motions', 'joints', 'painter']) {
      expect(ours.some((url) => url.includes(`/${part}-`)), `${part} is fetched when it is needed`).toBe(false);
    }
  } finally {
    await browser.close();
  }
});

it('shows five recent works with less than 60 kB of pictures', async () => {
  const made = await Promise.all(Array.from({ length: 5 }, () => order(portrait, 'happy', { trim: [0, 0.4] })));
  const ended = async (id: string) => (await ask<{ status: string }>(`/v1/jobs/${id}`)).status;
  await expect.poll(() => Promise.all(made.map(ended)), { timeout: LONG }).toEqual(made.map(() => 'succeeded'));
  const browser = await launch();
  try {
    const page = await open(browser);
    const posters = page.locator('.recent .entry .poster img');
    await expect.poll(() => posters.count()).toBeGreaterThanOrEqual(made.length);
    const shown = await posters.evaluateAll((images: HTMLImageElement[]) => images.map(({ src }) => src));
    const ours = shown.filter((url) => made.some((id) => url.includes(id)));
    expect(ours).toHaveLength(made.length);
    const sizes = await Promise.all(ours.map(async (url) => (await (await fetch(url)).arrayBuffer()).byteLength));
    expect(sizes.reduce((sum, size) => sum + size, 0)).toBeLessThan(60_000);
  } finally {
    await browser.close();
  }
});

import './nobody_works';
import { gzipSync } from 'node:zlib';
import { expect, it } from 'vitest';
import { launch } from './browser';
import { address, finished } from './own_service';
import { open } from './page';

const BUDGET = 200_000;

it('is there at the first load with less than 200 kB', async () => {
  const browser = await launch();
  try {
    const page = await open(browser);
    await page.getByRole('radio').first().waitFor({ state: 'attached' });
    await page.waitForLoadState('networkidle'); // nothing more is asked for
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
  const browser = await launch();
  try {
    const page = await open(browser);
    const posters = page.locator('.recent .entry .poster img');
    const ours = async (): Promise<string[]> => {
      const shown = await posters.evaluateAll((images: HTMLImageElement[]) => images.map(({ src }) => src));
      return shown.filter((url) => [finished.portrait, finished.character].some((id) => url.includes(id)));
    };
    await expect.poll(ours).toHaveLength(2);
    const sizes = await Promise.all((await ours()).map(async (url) => (await (await fetch(url)).arrayBuffer()).byteLength));
    expect(Math.max(...sizes), 'five like the heavier one').toBeLessThan(60_000 / 5);
  } finally {
    await browser.close();
  }
});

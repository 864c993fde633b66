/** The picture on a wall, and who steps out of it. */

import './nobody_works';
import { describe, expect, it } from 'vitest';
import { lacks } from './lacks';
import { ask } from './page';
import { aViewer, differing, mode, ready, shot, still } from './viewer_kit';

const { open, job, picture } = aViewer();

describe('the picture on the wall', () => {
  it('is the picture that was sent, until the person steps out and leaves it empty', async (context) => {
    const page = await open({ deviceScaleFactor: 1 });
    await ready(page);
    if ((await page.evaluate(() => window.picture())) === null) context.skip('the job does not say where its camera stood');
    await mode(page, 'On the wall').click();
    await still(page);
    const place = (await page.evaluate(() => window.picture()))!;
    const [left, top, right, bottom] = place;
    const canvas = (await page.locator('canvas').boundingBox())!;
    const clip = { x: canvas.x + left, y: canvas.y + top, width: right - left, height: bottom - top };
    /** Mean difference from a picture, in shares of the brightest, where both are as large as the smaller. */
    const from = async (url: string): Promise<number> => {
      const seen = (await page.screenshot({ clip })).toString('base64');
      return page.evaluate(
        async ([seen, url]) => {
          const blobs = await Promise.all([fetch(`data:image/png;base64,${seen}`), fetch(url)].map(async (got) => (await got).blob()));
          const [one, other] = (await Promise.all(
            blobs.map(async (blob) => {
              const pen = new OffscreenCanvas(90, 120).getContext('2d')!;
              pen.drawImage(await createImageBitmap(blob), 0, 0, 90, 120);
              return pen.getImageData(0, 0, 90, 120).data;
            }),
          )) as [Uint8ClampedArray, Uint8ClampedArray];
          return one.reduce((sum, value, index) => sum + Math.abs(value - other[index]!), 0) / one.length / 255;
        },
        [seen, url] as const,
      );
    };
    const sent = `data:image/png;base64,${picture().toString('base64')}`;
    const { artifacts } = await ask<{ artifacts: Record<string, { url: string }> }>(`/v1/jobs/${job()}`);
    const empty = artifacts['background.png']!.url;
    await expect.poll(() => from(sent), { message: 'in the picture, as it was' }).toBeLessThan(0.02);
    await expect.poll(async () => (await from(sent)) / (await from(empty))).toBeLessThan(0.5);

    // from aside, too: it is paint
    await page.locator('.viewer-stage').focus();
    for (let press = 0; press < 3; press++) await page.keyboard.press('ArrowRight');
    await page.locator('.viewer-stage').blur();
    await still(page);
    const aside = await shot(page);
    await page.getByRole('button', { name: 'Play' }).click();
    await expect.poll(() => differing(page, aside), { interval: 500 }).toBeGreaterThan(2000); // pictures cost those who walk time
    await page.getByRole('button', { name: 'Back into the picture' }).click();
    await expect.poll(() => differing(page, aside), { message: 'as before' }).toBe(0);
    const back = page.getByRole('button', { name: 'Back into the picture' });
    await lacks(page.getByRole('button', { name: 'View in VR headset' }), back); // no headset, no button
  });
});

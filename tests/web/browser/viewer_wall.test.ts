/** The picture on a wall, and who steps out of it. */

import { describe, expect, it } from 'vitest';
import { ask } from './page';
import { aViewer, differing, mode, ready, shot, still } from './viewer_kit';

const { open, job, picture } = aViewer();

describe('the picture on the wall', () => {
  it('is the picture that was sent, until the person steps out and leaves it empty', async (context) => {
    const page = await open();
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
    const atFirst = await from(sent);
    expect(atFirst, 'in the picture, as it was').toBeLessThan(0.02);
    expect(atFirst).toBeLessThan((await from(empty)) / 2);

    // from aside, too: it is paint
    await page.locator('.viewer-stage').focus();
    for (let press = 0; press < 3; press++) await page.keyboard.press('ArrowRight');
    await page.locator('.viewer-stage').blur();
    await still(page);
    const aside = await shot(page);
    await page.getByRole('button', { name: 'Play' }).click();
    await page.waitForTimeout(6000);
    await page.getByRole('button', { name: 'Pause' }).click();
    await still(page);
    expect(await differing(page, aside, await shot(page))).toBeGreaterThan(2000);
    await page.getByRole('button', { name: 'Back into the picture' }).click();
    await still(page);
    expect(await differing(page, aside, await shot(page)), 'as before').toBe(0);
    expect(await page.getByRole('button', { name: 'View in VR headset' }).count(), 'no headset, no button').toBe(0);
  });
});

/** Several people who were woken together: all where they stood, or one of them. */

import './characters_only';
import type { Page } from 'playwright-core';
import { describe, expect, it } from 'vitest';
import { ask } from './page';
import { aViewer, differing, mode, ready, shot, still } from './viewer_kit';

const { open, job } = aViewer('two');
const hips = (page: Page) => page.evaluate(() => window.hips());
const pressed = (page: Page) => page.getByRole('group', { name: 'Who' }).locator('[aria-pressed=true]').allTextContents();

describe('two people', () => {
  it('stand as they do in the picture, and begin each clip there', async () => {
    const page = await open();
    await ready(page);
    await expect.poll(() => pressed(page)).toEqual(['Everyone']);
    await page.getByRole('combobox', { name: 'Motion' }).selectOption('pictured');
    await still(page);
    const [first, second] = await hips(page);
    expect(second![0] - first![0], 'metres to the right').toBeGreaterThan(1);
    // the same picture, four fifths as large: a quarter further off, so nearly as far behind as that is
    const { url } = (await ask<{ artifacts: Record<string, { url: string }> }>(`/v1/jobs/${job()}`)).artifacts['skeleton.json']!;
    const { camera } = (await (await fetch(new URL(url, page.url()))).json()) as { camera: { eye: number[] } };
    const further = (camera.eye[2]! - second![2]) / (camera.eye[2]! - first![2]);
    expect(further).toBeGreaterThan(1.1);
    expect(further).toBeLessThan(1.4);
    for (const clip of ['walk', 'idle']) {
      await page.getByRole('combobox', { name: 'Motion' }).selectOption(clip);
      await still(page);
      for (const [index, [x, , z]] of (await hips(page)).entries()) {
        const [wasX, , wasZ] = [first!, second!][index]!;
        expect(Math.hypot(x - wasX, z - wasZ), `${clip} of ${index + 1}`).toBeLessThan(0.01);
      }
    }
  });

  it('are shown alone, too, and together again', async () => {
    const page = await open();
    await ready(page);
    const together = await shot(page);
    await mode(page, 'Person 2').click();
    await still(page);
    await expect.poll(() => pressed(page)).toEqual(['Person 2']);
    await expect.poll(async () => (await hips(page)).length).toBe(1);
    await expect.poll(() => differing(page, together)).toBeGreaterThan(1000);
    await mode(page, 'Everyone').click();
    await expect.poll(() => differing(page, together)).toBe(0);
  });

  it('are posed one at a time, and it is said that the pose is everybody’s', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'Change the pose').click();
    await still(page);
    await expect.poll(() => pressed(page)).toEqual(['Person 1']);
    await expect.poll(async () => (await hips(page)).length).toBe(1);
    await page.getByText('It is made for all 2 people').waitFor();
    await page.getByRole('combobox', { name: 'Bone' }).selectOption('Head');
    await page.getByRole('slider', { name: 'Twist' }).focus();
    await page.keyboard.press('ArrowRight');
    await mode(page, 'Person 2').click(); // the same pose on somebody else
    await still(page);
    await page.getByRole('button', { name: 'Apply pose' }).click();
    await expect.poll(() => page.evaluate(() => window.poses)).toEqual([{ Head: [0, 1, 0] }]);
  });

  it('step out of the wall together, none of them behind it', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'On the wall').click();
    await still(page);
    await expect.poll(async () => (await hips(page)).map(([, , z]) => z > -0.3)).toEqual([true, true]);
    await mode(page, 'Look around').click();
    await expect.poll(async () => (await hips(page))[1]![2], { message: 'back where they stood' }).toBeLessThan(-1);
  });

  it('are taken into one’s own room one by one', async () => {
    const page = await open();
    await ready(page);
    await page.getByRole('button', { name: 'View in your space' }).click();
    const shown = () => page.evaluate(() => new URL(document.querySelector('model-viewer')?.src ?? 'http://x').pathname);
    const inRoom = page.getByRole('dialog');
    await expect.poll(shown).toMatch(/\/character\.glb$/);
    await inRoom.getByRole('button', { name: 'Person 2' }).click();
    await expect.poll(shown).toMatch(/\/character-2\.glb$/);
    const quickLook = () => page.evaluate(() => document.querySelector('model-viewer')!.iosSrc);
    await expect.poll(quickLook).toMatch(/\/character-2\.usdz/);
  });
});

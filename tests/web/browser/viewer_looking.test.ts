/** A character from all sides. */

import './nobody_works';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import type { AxeResults } from 'axe-core';
import type { Locator, Page } from 'playwright-core';
import { describe, expect, it } from 'vitest';
import { launch } from './browser';
import { settled } from './settled';
import { aViewer, CLIPS, differing, drawings, mode, ready, shot, still, turns } from './viewer_kit';

declare global {
  interface Window {
    context: WebGL2RenderingContext;
  }
}

const { open } = aViewer();

/** What of somebody goes farthest. */
const EXTREMES = ['Head', 'LeftHand', 'RightHand', 'LeftFoot', 'RightFoot'];

/** Where a slider is that tells seconds. */
const seconds = async (slider: Locator): Promise<number> => Number(await slider.inputValue());

/** Until the clip that plays has begun anew by itself. */
async function wentAround(page: Page): Promise<void> {
  const farthest = await page.evaluateHandle(() => ({ second: 0 }));
  await page.waitForFunction(
    (so) => {
      const now = document.querySelector<HTMLInputElement>('.scrub')!.valueAsNumber;
      so.second = Math.max(so.second, now);
      return now < so.second;
    },
    farthest,
  );
}

describe('a character in three', () => {
  it('has every clip, and each moves the mesh with its joints', async () => {
    const page = await open();
    await ready(page);
    const { clips } = await page.evaluate(() => window.measure());
    expect(Object.keys(clips)).toEqual(CLIPS);
    expect(clips.pictured).toMatchObject({ vertex: 0, joint: 0, loops: false });
    for (const [name, least] of [['step_out', 0.3], ['walk', 0.3], ['walk_in_place', 0.2], ['idle', 0.001], ['dance', 0.1], ['bow', 0.2], ['sit', 0.2]] as const) {
      expect(clips[name]!.joint, `joints of ${name}`).toBeGreaterThan(least);
      expect(clips[name]!.vertex, `mesh of ${name}`).toBeGreaterThan(least);
    }
    expect(clips.walk!.loops && clips.walk_in_place!.loops && clips.idle!.loops).toBe(true);
    expect(clips.step_out!.loops).toBe(false);
  });
});

describe('looking around', () => {
  it('shows a clip at any of its moments, plays it, and draws only what has changed', async () => {
    const page = await open();
    await ready(page);
    await settled(() => drawings(page), 600); // at rest nothing is drawn

    const begin = await shot(page);
    const position = page.getByRole('slider', { name: 'Position' });
    await position.fill('0.5');
    await expect.poll(() => differing(page, begin)).toBeGreaterThan(300);
    await position.fill('0');
    await expect.poll(() => differing(page, begin), { message: 'going back is coming back' }).toBe(0);

    await page.getByRole('combobox', { name: 'Motion' }).selectOption('step_out');
    const tall = () => page.evaluate(() => window.joint('LeftFoot')[1] - window.joint('Head')[1]);
    await still(page);
    const before = await tall();
    await page.getByRole('button', { name: 'Play' }).click();
    await page.getByRole('button', { name: 'Play' }).waitFor(); // it ends by itself
    await expect.poll(() => tall(), { message: 'the person has come nearer' }).toBeGreaterThan(1.1 * before);
    await expect.poll(async () => (await seconds(position)) - Number(await position.getAttribute('max'))).toBeCloseTo(0, 1);
  });

  it('shows the chosen motion first, and any other by its plain name, all of it within the stage', async () => {
    const page = await open();
    await ready(page);
    const motion = page.getByRole('combobox', { name: 'Motion' });
    await expect.poll(() => motion.inputValue()).toBe('walk_in_place');
    await expect.poll(() => motion.getByRole('option').allTextContents()).toEqual([
      ...['Pose from the picture', 'Out of the picture', 'Walk', 'Walk, in place'],
      ...['Idle', 'Run, in place', 'Jump', 'Sit down', 'Wave', 'Dance', 'Bow'],
    ]);
    const position = page.getByRole('slider', { name: 'Position' });
    const { width, height } = (await page.locator('.viewer-stage').boundingBox())!;
    const pictures = new Set<string>();
    for (const name of CLIPS.slice(4)) {
      await motion.selectOption(name);
      await still(page);
      const end = Number(await position.getAttribute('max'));
      for (let moment = 0; moment <= 8; moment++) {
        await position.fill(String((moment * end) / 8));
        await turns(page, 2);
        const places = await page.evaluate((joints) => joints.map((joint) => [joint, ...window.joint(joint)] as const), EXTREMES);
        for (const [joint, x, y] of places) {
          const seen = x > 0 && x < width && y > 0 && y < height;
          expect(seen, `${joint} of ${name} at ${moment}/8: ${x}, ${y} of ${width} x ${height}`).toBe(true);
        }
        if (moment === 3) pictures.add((await shot(page)).toString('base64'));
      }
    }
    expect(pictures.size, 'each is another one').toBe(CLIPS.length - 4);
  });

  it('plays on and on what ends as it begins, and once what does not', async () => {
    const page = await open();
    await ready(page);
    const motion = page.getByRole('combobox', { name: 'Motion' });
    const position = page.getByRole('slider', { name: 'Position' });
    for (const name of ['jump', 'run_in_place']) {
      await motion.selectOption(name);
      await position.fill(String(Number(await position.getAttribute('max')) - 0.1)); // a busy machine draws a frame in seconds
      await page.getByRole('button', { name: 'Play' }).click();
      await wentAround(page);
      await page.getByRole('button', { name: 'Pause' }).click();
    }
    await motion.selectOption('sit');
    await position.fill('2.5');
    await page.getByRole('button', { name: 'Play' }).click();
    await page.getByRole('button', { name: 'Play' }).waitFor(); // seated, they stay
    await expect.poll(() => seconds(position)).toBeGreaterThan(2.9);
  });

  it('is circled around by mouse and keys, and comes back', async () => {
    const page = await open();
    await ready(page);
    const front = await shot(page);
    const { x, y, width, height } = (await page.locator('.viewer-stage').boundingBox())!;
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 180, y + height / 2, { steps: 4 });
    await page.mouse.up();
    await expect.poll(() => differing(page, front)).toBeGreaterThan(1000);
    await page.getByRole('button', { name: 'View from the front' }).click();
    await expect.poll(() => differing(page, front)).toBe(0);
    await page.locator('.viewer-stage').focus();
    await page.keyboard.press('ArrowLeft');
    await still(page);
    const [turned] = await page.evaluate(() => window.joint('LeftHand'));
    await page.keyboard.press('ArrowRight');
    const moved = () => page.evaluate((so) => Math.abs(window.joint('LeftHand')[0] - so), turned);
    await expect.poll(moved).toBeGreaterThan(3);
    for (const key of ['ArrowUp', '+', '+', '-', 'ArrowDown', '-']) await page.keyboard.press(key);
    await page.locator('.viewer-stage').blur();
    await expect.poll(() => differing(page, front), { message: 'each key undoes another' }).toBeLessThan(20);
  });

  it('shows the skeleton over the mesh, and another background', async () => {
    const page = await open();
    await ready(page);
    const bare = await shot(page);
    await page.getByRole('button', { name: 'Skeleton' }).click();
    await expect.poll(() => differing(page, bare)).toBeGreaterThan(150);
    await page.getByRole('button', { name: 'Skeleton' }).click();
    await expect.poll(() => differing(page, bare)).toBe(0);
    await page.getByRole('button', { name: 'Dark background' }).click();
    const all = (await page.locator('.viewer-stage').boundingBox())!;
    await expect.poll(() => differing(page, bare)).toBeGreaterThan(0.6 * all.width * all.height);
  });

  it('gives the graphics back when it goes', async () => {
    const page = await open();
    await ready(page);
    await page.evaluate(() => {
      const context = document.querySelector('canvas')!.getContext('webgl2')!;
      window.leave();
      window.context = context;
    });
    const left = () => page.evaluate(() => [window.context.isContextLost(), document.querySelector('canvas')]);
    await expect.poll(left).toEqual([true, null]);
  });

  it('says so where there is no WebGL', async () => {
    const without = await launch(['--disable-3d-apis']);
    try {
      const page = await open({}, without);
      await page.getByText('This browser shows no 3D').waitFor();
      await page.getByRole('button', { name: 'View in your space' }).waitFor();
    } finally {
      await without.close();
    }
  });

  it.each(['light', 'dark'] as const)('is for everybody: no barriers that axe knows, %s', async (colorScheme) => {
    const page = await open({ colorScheme });
    await ready(page);
    const axe = createRequire(new URL('../../../web/package.json', import.meta.url)).resolve('axe-core/axe.min.js');
    await page.evaluate(readFileSync(axe, 'utf8'));
    for (const name of ['Look around', 'Change the pose']) {
      await mode(page, name).click();
      await still(page);
      const { violations } = await page.evaluate(
        () => (window as unknown as { axe: { run: (where: string) => Promise<AxeResults> } }).axe.run('.viewer'),
      );
      expect(violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)])).toEqual([]);
    }
  });
});

/** A pose by hand: dragged, turned by keys, told as degrees. */

import './nobody_works';
import type { Page } from 'playwright-core';
import { describe, expect, it } from 'vitest';
import { aViewer, differing, mode, ready, shot, still } from './viewer_kit';

const { open } = aViewer();

/** Pixels from the left hand to a place of the canvas. */
const away = (page: Page, x: number, y: number): Promise<number> =>
  page.evaluate((to) => Math.hypot(window.joint('LeftHand')[0] - to[0], window.joint('LeftHand')[1] - to[1]), [x, y] as const);

describe('a pose by hand', () => {
  it('brings the wrist under the pointer, and is told as degrees from the pictured pose', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'Change the pose').click();
    await still(page);
    const make = page.getByRole('button', { name: 'Apply pose' });
    await expect.poll(() => make.isDisabled()).toBe(true);
    const [x, y] = await page.evaluate(() => window.joint('LeftHand'));
    const [toX, toY] = [x + 12, y - 70];
    const canvas = (await page.locator('canvas').boundingBox())!;
    const pointer = (right: number, down: number) => page.mouse.move(canvas.x + right, canvas.y + down);
    await pointer(x + 2, y + 1);
    await page.mouse.down();
    await pointer(toX + 30, toY + 8);
    await pointer(toX + 2, toY + 1);
    await page.mouse.up();
    await expect.poll(() => away(page, toX, toY), { message: 'pixels from the pointer' }).toBeLessThan(1);
    await still(page);
    const raised = await page.evaluate(() => window.joint('LeftHand'));

    await make.click();
    await expect.poll(() => page.evaluate(() => window.poses.length)).toBe(1);
    const pose = (await page.evaluate(() => window.poses[0]))!;
    expect(Object.keys(pose).sort()).toEqual(['LeftArm', 'LeftForeArm']);
    const shown = await page.evaluate(() => window.rotations(['LeftArm', 'LeftForeArm']));
    for (const [index, name] of (['LeftArm', 'LeftForeArm'] as const).entries()) {
      const told = await page.evaluate(([name, degrees]) => window.turned(name, degrees), [name, pose[name]!] as const);
      const cosine = Math.abs(told.reduce((sum, part, axis) => sum + part * shown[index]![axis]!, 0));
      expect(Math.acos(Math.min(1, cosine)) * (360 / Math.PI), `degrees that ${name} is off`).toBeLessThan(0.05);
    }

    await page.getByRole('button', { name: 'Undo' }).click();
    await expect.poll(() => away(page, x, y)).toBeLessThan(0.01);
    await expect.poll(() => make.isDisabled()).toBe(true);
    await page.getByRole('button', { name: 'Redo' }).click();
    await expect.poll(() => page.evaluate(() => window.joint('LeftHand'))).toEqual(raised);
  });

  it('is made with the keyboard, too', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'Change the pose').click();
    await page.getByRole('combobox', { name: 'Bone' }).selectOption('Head');
    await page.getByRole('slider', { name: 'Twist' }).focus();
    for (let press = 0; press < 3; press++) await page.keyboard.press('ArrowRight');
    await page.getByRole('button', { name: 'Apply pose' }).click();
    await expect.poll(() => page.evaluate(() => window.poses)).toEqual([{ Head: [0, 3, 0] }]);
    await page.locator('.viewer-stage').focus();
    await page.keyboard.press('Control+z');
    await page.getByRole('button', { name: 'Apply pose' }).click();
    await expect.poll(() => page.evaluate(() => window.poses[1])).toEqual({ Head: [0, 2, 0] });
    await page.getByRole('button', { name: 'Pose from the picture' }).click();
    await expect.poll(() => page.getByRole('button', { name: 'Apply pose' }).isDisabled()).toBe(true);
  });

  it('turns the mesh half transparent while it is edited, and solid again', async () => {
    const page = await open();
    await ready(page);
    const solid = await shot(page);
    await mode(page, 'Change the pose').click();
    await expect.poll(() => differing(page, solid)).toBeGreaterThan(1000);
    await mode(page, 'Look around').click();
    await expect.poll(() => differing(page, solid)).toBe(0);
  });
});

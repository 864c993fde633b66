/** A pose by hand stands on the ground. */

import './characters_only';
import { describe, expect, it } from 'vitest';
import { aViewer, mode, ready, still } from './viewer_kit';

const { open } = aViewer('crouching');

describe('who is posed by hand', () => {
  it('is as far down as the engine puts them, and up again as pictured', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'Change the pose').click();
    await still(page);
    const height = async (): Promise<number> => (await page.evaluate(() => window.hips()))[0]![1];
    const [pictured, made] = await page.evaluate(() => Promise.all([window.begins('pictured'), window.begins('step_out')]));
    expect(pictured[1] - made[1], 'metres that the hips go down').toBeGreaterThan(0.2);
    const beside = async (so: number): Promise<number> => Math.abs((await height()) - so);
    await expect.poll(() => beside(made[1]), { message: 'metres beside the engine' }).toBeLessThan(0.002);
    await page.getByRole('button', { name: 'Pose from the picture' }).click();
    await expect.poll(() => beside(pictured[1])).toBeLessThan(1e-5);
  });

  it('lies on the ground where they are laid down, and stays while an arm is raised', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'Change the pose').click();
    const bone = page.getByRole('combobox', { name: 'Bone' });
    const height = async (): Promise<number> => {
      await still(page);
      return (await page.evaluate(() => window.hips()))[0]![1];
    };
    const before = await height();
    await bone.selectOption('LeftArm');
    const sliders = page.getByRole('slider');
    await sliders.first().waitFor();
    for (const slider of await sliders.all()) await slider.fill('40');
    await expect.poll(height).toBe(before);
    await bone.selectOption('Hips');
    await page.getByRole('slider').first().fill('90');
    await expect.poll(async () => before - (await height()), { message: 'metres that somebody lies lower' }).toBeGreaterThan(0.1);
  });
});

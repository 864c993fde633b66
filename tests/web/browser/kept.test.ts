import './nobody_works';
import { readFileSync } from 'node:fs';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { answered, complaints, expectComplaint } from './complaints';
import { readable } from './axe';
import { launch } from './browser';
import { lacks } from './lacks';
import { inPython } from './media';
import { address } from './own_service';
import { open } from './page';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  await keepNothing();
  expect(complaints.splice(0)).toEqual([]);
});

const video = inPython('from engine.performances import video; print(video("wink"))');
const bvh = `HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  End Site
  {
    OFFSET 0 10 0
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 0 0 0
0 0 0 5 0 0
`;

async function own(shelf: string): Promise<{ name: string }[]> {
  const { items } = (await (await fetch(`${address}/v1/${shelf}`)).json()) as { items: { name: string; source: string }[] };
  return items.filter(({ source }) => source === 'own');
}
const ownNames = async (shelf: string): Promise<string[]> => (await own(shelf)).map(({ name }) => name).sort();

async function keepNothing(): Promise<void> {
  for (const shelf of ['drivers', 'motions']) {
    for (const { name } of await own(shelf)) await fetch(`${address}/v1/${shelf}/${name}`, { method: 'DELETE' });
  }
}

async function keep(shelf: string, name: string, file: File): Promise<void> {
  const form = new FormData();
  form.append('name', name);
  form.append('file', file);
  const response = await fetch(`${address}/v1/${shelf}`, { method: 'POST', body: form });
  expect(response.ok, await response.text()).toBe(true);
}

const driver = (name: string): Promise<void> => keep('drivers', name, new File([readFileSync(video)], 'w.mp4'));
const card = (page: Page, name: string) => page.getByRole('radio', { name, exact: true });
const focused = (page: Page): Promise<string | null> =>
  page.evaluate(() => document.activeElement?.getAttribute('aria-label') ?? document.activeElement?.textContent ?? null);

describe('saved videos', () => {
  it('take another name where they stand, and stay chosen', async () => {
    await driver('wink-one');
    const page = await open(browser);
    await page.locator('label').filter({ has: card(page, 'Wink one') }).click();
    await page.getByText('Rename or delete').click();
    await page.getByRole('button', { name: 'Rename: Wink one' }).click();
    await page.keyboard.type('Aunt Mary');
    await page.keyboard.press('Enter'); // of the field, not of the form around it
    await card(page, 'Aunt mary').waitFor();
    await page.getByRole('radio', { name: 'Aunt mary', exact: true, checked: true }).waitFor({ state: 'attached' });
    await expect.poll(() => focused(page)).toBe('Rename: Aunt mary');
    expect(await ownNames('drivers')).toEqual(['aunt-mary']);
    await lacks(page.getByRole('alert'), card(page, 'Aunt mary'));
  });

  it('say beside the field why a name cannot be had', async () => {
    await driver('wink-one');
    const page = await open(browser);
    await page.getByText('Rename or delete').click();
    await page.getByRole('button', { name: 'Rename: Wink one' }).click();
    const field = page.getByRole('textbox', { name: 'New name of “Wink one”' });
    for (const [name, sentence] of [
      ['Happy', 'There is a driver “happy” already'],
      ['Möwe', 'a-z, 0-9'],
    ] as const) {
      await field.fill(name);
      await page.getByRole('button', { name: 'Save' }).click();
      await page.getByRole('alert').getByText(sentence).waitFor();
      await expect.poll(() => field.evaluate((input) => input === document.activeElement)).toBe(true);
      await expect.poll(() => field.getAttribute('aria-invalid')).toBe('true');
      await expect.poll(() => field.inputValue()).toBe(name);
    }
    await page.getByRole('button', { name: 'Delete: Wink one' }).click();
    await readable(page);
    await field.press('Escape');
    await expect.poll(() => focused(page)).toBe('Rename: Wink one');
    await lacks(page.getByRole('alert'), page.getByRole('button', { name: 'Rename: Wink one' }));
    expect(await ownNames('drivers')).toEqual(['wink-one']);
    expectComplaint(answered(409));
    expectComplaint(answered(422));
  });

  it('are deleted after a question, and the focus is not lost with them', async () => {
    await driver('wink-one');
    await driver('wink-two');
    const page = await open(browser);
    await page.locator('label').filter({ has: card(page, 'Wink two') }).click();
    await page.getByText('Rename or delete').click();
    const remove = page.getByRole('button', { name: 'Delete: Wink two' });
    await remove.click();
    const question = page.getByRole('group', { name: 'Delete “Wink two”? Results made with it stay.' });
    await question.waitFor();
    await expect.poll(() => focused(page)).toBe('Cancel');
    await page.keyboard.press('Enter');
    await expect.poll(() => focused(page)).toBe('Delete: Wink two');
    expect(await ownNames('drivers')).toEqual(['wink-one', 'wink-two']);

    await remove.click();
    await question.getByRole('button', { name: 'Delete' }).click();
    await card(page, 'Wink two').waitFor({ state: 'detached' });
    await expect.poll(() => focused(page)).toBe('“Wink two” was deleted.');
    await expect.poll(() => card(page, 'Best match').isChecked(), { message: 'what was chosen is gone' }).toBe(true);
    await page.getByRole('button', { name: 'Delete: Wink one' }).click();
    await page.getByRole('group', { name: /Wink one/ }).getByRole('button', { name: 'Delete' }).click();
    await expect.poll(() => focused(page)).toBe('“Wink one” was deleted.');
    await page.getByText('Rename or delete').waitFor({ state: 'detached' });
    expect(await ownNames('drivers')).toEqual([]);
  });
});

describe('saved motions', () => {
  it('are renamed and deleted likewise, those that can move nobody among them', async () => {
    await keep('motions', 'one-bone', new File([bvh], 'bone.bvh'));
    const page = await open(browser, '#/character');
    await page.getByText('Rename or delete').click();
    await page.getByRole('button', { name: 'Rename: One bone' }).click();
    await page.keyboard.type('lonely bone');
    await page.keyboard.press('Enter');
    await page.getByRole('button', { name: 'Rename: Lonely bone' }).waitFor();
    expect(await ownNames('motions')).toEqual(['lonely-bone']);
    await page.getByRole('button', { name: 'Delete: Lonely bone' }).click();
    await page.getByRole('group', { name: /Lonely bone/ }).getByRole('button', { name: 'Delete' }).click();
    await expect.poll(() => focused(page)).toBe('“Lonely bone” was deleted.');
    expect(await ownNames('motions')).toEqual([]);
  });
});

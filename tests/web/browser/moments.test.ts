import './moments_only';
import type { Browser } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { complaints } from './complaints';
import { launch } from './browser';
import { LONG } from './jobs';
import { lacks } from './lacks';
import { inPython, portrait } from './media';
import { address } from './own_service';
import { ask, jobOf, open } from './page';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const video = inPython('from engine.performances import video; print(video("surprise"))');

it('keeps a video, finds the emotions in it, and has one of them acted out', { timeout: LONG }, async () => {
  const page = await open(browser);
  let answer = (): void => undefined;
  const clicked = new Promise<void>((done) => (answer = done));
  // It does not know yet which names are taken.
  await page.route('**/v1/drivers', (route) => clicked.then(() => route.continue()), { times: 1 });
  await page.reload();
  await page.getByLabel(/Drop a picture|Portrait:/).setInputFiles(portrait);
  await page.getByLabel(/Drop a video|Video:/).setInputFiles(video);
  await page.getByRole('button', { name: 'Save it and find the emotions in it' }).click();
  answer();
  const whole = page.getByRole('radio', { name: 'Surprise 2', exact: true }); // “surprise” is a built-in one's name
  await whole.waitFor();
  await expect.poll(() => whole.isChecked()).toBe(true);
  const moment = page.getByRole('radio', { name: /^Surprise(, strong)?, \d\.\d s$/ });
  await moment.waitFor({ timeout: LONG });
  await lacks(page.getByText('Looking for emotions'), moment);
  await page.locator('label').filter({ has: moment }).click();
  await expect.poll(() => moment.isChecked()).toBe(true);
  const shown = page.locator('label').filter({ has: moment }).locator('img');
  await expect.poll(() => shown.evaluate((picture: HTMLImageElement) => picture.naturalWidth)).toBe(256);

  await page.getByRole('button', { name: 'Bring it to life' }).click();
  await page.waitForURL(/#\/jobs\//);
  const job = await ask<{ inputs: { driver: string }; options: { trim: number[] } }>(
    `/v1/jobs/${jobOf(page)}`,
  );
  const driver = await ask<{ moments: { name: string; start: number; end: number }[] }>('/v1/drivers/surprise-2');
  const found = driver.moments[0];
  expect([job.inputs.driver, job.options.trim]).toEqual([`surprise-2/${found?.name}`, [found?.start, found?.end]]);

  // The search is no entry among what was made.
  await page.goto(`${address}/#/history`);
  await lacks(page.getByText('Moments'), page.locator('.work').getByText('Grace hopper'));
});

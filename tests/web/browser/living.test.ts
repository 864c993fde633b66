/** A portrait that is made and played on demand, all on the page. */

import './nobody_works';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { complaints } from './complaints';
import { launch } from './browser';
import { portrait } from './media';
import { finished } from './own_service';
import { open } from './page';

let browser: Browser;
const job = finished.reactive;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

it('comes without a performance, and shows what is asked for', async () => {
  const page = await open(browser, `#/jobs/${job}`);
  const happy = page.getByRole('button', { name: 'Happy', exact: true });
  await happy.waitFor();
  await page.getByRole('button', { name: 'Idle', pressed: true }).waitFor();
  await happy.click();
  await page.getByRole('button', { name: 'Happy', pressed: true }).waitFor();
  const bundle = page.getByRole('link', { name: /Download for a web page/ });
  await expect.poll(() => bundle.getAttribute('href')).toMatch(/profile\.zip$/);
  expect(complaints.splice(0)).toEqual([]);
});

it('is a card among the performances', async () => {
  const page = await open(browser);
  await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
  await page.locator('form').getByText('Interactive', { exact: true }).click();
  const ordered = page.waitForRequest((request) => request.url().endsWith('/v1/jobs') && request.method() === 'POST');
  await page.getByRole('button', { name: 'Bring it to life' }).click();
  const body = (await ordered).postDataJSON() as { inputs: object; options: object };
  expect(Object.keys(body.inputs)).toEqual(['image']);
  expect(body.options).toEqual({ reactive: true });
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('Canceled', { exact: true }).first().waitFor();
});

it('says so where it cannot be played', async () => {
  const page = await open(browser);
  await page.route('**/reactive-portrait.js', (route) => route.abort());
  await page.evaluate((job) => (location.hash = `#/jobs/${job}`), job);
  await page.getByText('The portrait could not be loaded completely. Reload the page.').waitFor();
});

import './portraits_only';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { answered, complaints, expectComplaint, unanswered } from './complaints';
import { launch } from './browser';
import { LONG, SMALL } from './jobs';
import { lacks } from './lacks';
import { faceless } from './media';
import { address, finished } from './own_service';
import { cancelAll, open, openRunning, openWaiting, order } from './page';
import { settled } from './settled';

let browser: Browser;
const done = finished.portrait;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  await cancelAll();
  expect(complaints.splice(0)).toEqual([]);
});

describe('a job that succeeds', () => {
  it('shows its stages and a first impression on the way, then the result beside the performance', async () => {
    const { page, begin } = await openWaiting(browser, 'idle');
    await begin();
    await page.getByRole('list', { name: 'Stages' }).getByText('Animating').waitFor({ timeout: LONG });
    await page.getByRole('img', { name: 'A first frame of the result' }).waitFor();
    await expect.poll(() => page.getByRole('progressbar').getAttribute('value')).toMatch(/^0?\.\d+|1$/);
    const result = page.getByRole('region', { name: 'Result and performance' });
    await result.waitFor({ timeout: LONG });
    await lacks(page.getByRole('progressbar'), result);
    await page.getByText('Done', { exact: true }).first().waitFor();
  });

  it('plays both in step', async () => {
    const page = await open(browser, `#/jobs/${done}`, { reducedMotion: 'reduce' });
    await loaded(page);
    await expect.poll(() => times(page)).toEqual([0, 0]); // reduced motion: nothing moves by itself
    await page.getByRole('button', { name: 'Play' }).click();
    await page.waitForFunction(() => (document.querySelector('video')?.currentTime ?? 0) > 1);
    await page.getByRole('button', { name: 'Pause' }).click();
    await inStep(page);
    await page.getByLabel('Position').fill('0.4');
    await inStep(page);
    await expect.poll(async () => (await times(page))[0]).toBeCloseTo(0.4, 1);
  });

  it('gives the video and all files', async () => {
    const page = await open(browser, `#/jobs/${done}`);
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      page.getByRole('link', { name: 'Download video' }).click(),
    ]);
    expect(download.suggestedFilename()).toBe('animation.mp4'); // whoever ordered it gave no name
    await page.getByText('All files').click();
    const [archive] = await Promise.all([
      page.waitForEvent('download'),
      page.getByRole('link', { name: 'Download all as ZIP' }).click(),
    ]);
    expect(archive.suggestedFilename()).toBe(`portrait-${done}.zip`);
    const report = await page.getByRole('link', { name: 'report.json' }).getAttribute('href');
    expect(await (await fetch(address + report)).json()).toMatchObject({ kind: 'portrait' });
  });

  it('is found among the recent ones, with its poster', async () => {
    const page = await open(browser);
    const entry = page.locator(`a[href="#/jobs/${done}"]`);
    await entry.locator('img').waitFor();
    await entry.click();
    await page.getByRole('region', { name: 'Result and performance' }).waitFor();
  });

  it.each([320, 390, 1440])('fits a window of %i pixels, start page and result', async (width) => {
    const page = await open(browser, `#/jobs/${done}`, { viewport: { width, height: 800 }, reducedMotion: 'reduce' });
    await loaded(page);
    const overflow = () => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    await expect.poll(() => overflow()).toBeLessThanOrEqual(0);
    await page.getByRole('link', { name: 'Make another' }).click();
    await page.getByRole('radio').first().waitFor({ state: 'attached' });
    await expect.poll(() => overflow()).toBeLessThanOrEqual(0);
  });

  it.each([390, 1280])('has one row of what can be done, which stays where it is whatever opens, %i pixels wide', async (width) => {
    const page = await open(browser, `#/jobs/${done}`, { viewport: { width, height: 900 }, reducedMotion: 'reduce' });
    await loaded(page);
    const buttons = page.locator('.result-actions .toolbar').getByRole('button');
    await expect.poll(() => buttons.allInnerTexts()).toEqual(['All files', 'Share', 'Use in code']);
    /** Pixels from the row's corner, all of one moment. */
    const places = () =>
      buttons.evaluateAll((all) => {
        const row = document.querySelector('.result-actions')!.getBoundingClientRect();
        return all.map((button) => {
          const { left, top } = button.getBoundingClientRect();
          return [left - row.left, top - row.top].map(Math.round);
        });
      });
    const before = await settled(places);
    for (const button of await buttons.all()) await button.click();
    await page.getByRole('button', { name: 'Create link' }).waitFor();
    const copy = page.getByRole('button', { name: /^Copy: / }).first();
    await copy.waitFor();
    await expect.poll(() => places()).toEqual(before);

    /** Pixels by which a button to copy reaches beyond its snippet to the right, and into its text: of one moment. */
    const beyond = () =>
      page.locator('.snippet').first().evaluate((snippet) => {
        const [button, text] = ['button', 'pre'].map((one) => snippet.querySelector(one)!.getBoundingClientRect());
        return Math.max(button!.right - snippet.getBoundingClientRect().right, button!.bottom - text!.top);
      });
    await expect.poll(beyond).toBeLessThanOrEqual(0.5);
  });

  it('is made again with something changed, and the two lead to each other', async () => {
    const page = await open(browser, `#/jobs/${done}`);
    await page.getByText('Edit and make again').click();
    await page.getByLabel('Strength').fill('0.5');
    await page.getByLabel('Head', { exact: true }).uncheck();
    await page.getByLabel('Neutral frame of the performance').fill('3');
    await page.getByRole('button', { name: 'Make it again' }).click();
    await page.waitForURL((url) => !url.hash.endsWith(done));
    await page.getByRole('region', { name: 'Result and performance' }).waitFor({ timeout: LONG });
    const revised = page.url().split('/').at(-1) ?? '';
    const job = await (await fetch(`${address}/v1/jobs/${revised}`)).json();
    expect(job.revision_of).toBe(done);
    expect(job.options).toEqual({ ...SMALL, strength: 0.5, follow: ['eyes', 'brows', 'mouth'], neutral_frame: 3 });
    const report = await (await fetch(address + job.artifacts['report.json'].url)).json();
    expect(report.inputs.neutral_frame).toBe(3);

    const versions = page.getByRole('navigation', { name: 'Versions' });
    await versions.getByRole('link', { name: '2' }).and(page.locator('[aria-current=page]')).waitFor();
    await versions.getByRole('link', { name: '1' }).click();
    await page.waitForURL((url) => url.hash.endsWith(done));
    await versions.getByRole('link', { name: '1' }).and(page.locator('[aria-current=page]')).waitFor();
  });
});

describe('a job that does not', () => {
  it('says why it failed and what to do', async () => {
    const id = finished.noFace;
    const page = await open(browser, `#/jobs/${id}`);
    const alert = page.getByRole('alert');
    await alert.getByText('No face was found', { exact: true }).waitFor({ timeout: LONG });
    const job = (await (await fetch(`${address}/v1/jobs/${id}`)).json()) as { error: { detail: string } };
    await expect.poll(() => alert.innerText()).toContain(job.error.detail);
    await alert.getByRole('link', { name: 'Choose another picture' }).waitFor();
    const closed = page.getByText('Correct and try again');
    await lacks(page.getByRole('button', { name: 'Make it again' }), closed); // until it is asked for
    await page.getByRole('link', { name: 'Make another' }).waitFor();
  });

  it('is canceled at a click', async () => {
    const page = await openRunning(browser);
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.getByText('This job was canceled before it was done').waitFor({ timeout: LONG });
  });

  it('is deleted only after a question', async () => {
    const id = await order(faceless, 'idle');
    const page = await open(browser, `#/jobs/${id}`);
    await page.getByRole('button', { name: 'Delete' }).click({ timeout: LONG });
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.getByRole('button', { name: 'Delete' }).click();
    await page.getByRole('button', { name: 'Delete permanently' }).click();
    await page.getByRole('heading', { name: 'Bring a portrait to life' }).waitFor();
    expect((await fetch(`${address}/v1/jobs/${id}`)).status).toBe(404);
  });

  it('is missed in plain words', async () => {
    const page = await open(browser, '#/jobs/0198c1d2-7b1a-7c3e-9c6d-0a1b2c3d4e5f');
    await page.getByRole('heading', { name: 'Job not found' }).waitFor();
    expectComplaint(answered(404));
  });
});

describe('a job on its way', () => {
  it('has its place in the queue told while it waits', async () => {
    const page = await openRunning(browser, 2);
    await page.getByText(/^(Next|Place \d) in the queue$/).waitFor();
    await cancelAll();
    await page.getByText('Canceled', { exact: true }).first().waitFor({ timeout: LONG });
  });

  it('keeps its stages in the order of the work when the page is loaded anew', async () => {
    const page = await openRunning(browser);
    const stages = page.getByRole('list', { name: 'Stages' }).getByRole('listitem');
    const names = async () => (await stages.allInnerTexts()).map((text) => text.split('\n')[0]!.replace(/ (running|done)$/, ''));
    await expect.poll(() => stages.count(), { timeout: LONG }).toBeGreaterThan(1);
    const before = await names();
    await page.reload();
    await stages.first().waitFor();
    await expect.poll(async () => (await names()).slice(0, before.length)).toEqual(before);
  });
});

describe('a broken line', () => {
  it('is told, and mends itself', async () => {
    const { page, begin } = await openWaiting(browser, 'happy');
    await page.context().setOffline(true);
    await page.evaluate(() => dispatchEvent(new Event('offline')));
    await page.getByText('Connection lost').waitFor();
    await page.context().setOffline(false);
    await begin();
    await page.getByRole('region', { name: 'Result and performance' }).waitFor({ timeout: LONG });
    expectComplaint(unanswered);
  });
});

const times = (page: Page): Promise<number[]> =>
  page.evaluate(() => Array.from(document.querySelectorAll('video'), (video) => video.currentTime));

async function loaded(page: Page): Promise<void> {
  await page.waitForFunction(() => {
    const videos = Array.from(document.querySelectorAll('video'));
    return videos.length === 2 && videos.every((video) => video.readyState >= 3);
  });
}

/** Waits until both videos rest on the same moment; two frames may lie between them. */
async function inStep(page: Page): Promise<void> {
  await page.waitForFunction(() => {
    const [result, driver] = Array.from(document.querySelectorAll('video'));
    return (
      result && driver && !result.seeking && !driver.seeking && Math.abs(result.currentTime - driver.currentTime) < 0.08
    );
  });
}

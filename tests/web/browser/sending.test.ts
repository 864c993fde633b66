import './nobody_works';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints } from './complaints';
import { launch } from './browser';
import { media, portrait } from './media';
import { ask, jobOf, nothingToResume, open } from './page';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const start = (page: Page) => page.getByRole('button', { name: 'Bring it to life' });
const bar = (page: Page) => page.getByRole('progressbar');
const share = async (page: Page): Promise<number> => Number(await bar(page).getAttribute('value'));

/** The start page with a portrait and a video chosen, on a line that takes some seconds for the video. */
async function chosen(video: string): Promise<{ page: Page; speed: (bytesPerSecond: number) => Promise<unknown> }> {
  const page = await open(browser);
  // One session for both: what another said of the line would go on to hold beside it.
  const line = await page.context().newCDPSession(page);
  const speed = (uploadThroughput: number) =>
    line.send('Network.emulateNetworkConditions', { offline: false, latency: 0, downloadThroughput: -1, uploadThroughput });
  await speed(150_000);
  await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
  await page.getByLabel(/Drop a video/).setInputFiles(video);
  return { page, speed };
}

describe('sending a video', () => {
  it('halts and goes on, survives a reload, and orders what was wanted', async ({ skip }) => {
    const video = media('driving/man_grimace_d0.mp4') ?? skip('the shared test media are not here');
    const { page, speed } = await chosen(video);
    await start(page).click();
    await page.getByText(/Uploading the video: [2-9]\d%/).waitFor();
    await page.getByRole('button', { name: 'Pause', exact: true }).click();
    await page.getByText(/Paused while uploading the video/).waitFor();
    const halted = await share(page);
    await page.waitForTimeout(1500);
    await expect.poll(() => share(page)).toBe(halted);
    await page.getByRole('button', { name: 'Resume', exact: true }).click();
    await expect.poll(() => share(page)).toBeGreaterThan(halted + 0.05);

    const asked: string[] = [];
    page.on('request', (request) => asked.push(`${request.method()} ${new URL(request.url()).pathname.split('/')[2]}`));
    await page.reload();
    await page.getByText(/The upload of “Grace hopper” \(Man grimace d0\) was interrupted/).waitFor();
    await page.getByRole('button', { name: 'Resume upload' }).click();
    await page.getByText(/Uploading the video: [3-9]\d%/).waitFor();
    await speed(-1);
    await page.getByRole('heading', { name: 'Grace hopper' }).waitFor();
    expect(asked).toContain('HEAD uploads');
    expect(asked.includes('POST uploads')).toBe(false); // neither file was begun again
    const job = await ask<{ inputs: { driver: string } }>(`/v1/jobs/${jobOf(page)}`);
    const { size } = await ask<{ size: number }>(`/v1/files/${job.inputs.driver}`);
    expect(size).toBeGreaterThan(100_000);
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.getByText('This job was canceled before it was done').waitFor();
    await page.goto(page.url().replace(/#.*/, ''));
    await nothingToResume(page);
  });

  it('to be kept as a driver halts and goes on, too', async ({ skip }) => {
    const video = media('driving/man_grimace_d0.mp4') ?? skip('the shared test media are not here');
    const { page, speed } = await chosen(video);
    await page.getByRole('button', { name: 'Save it and find the emotions in it' }).click();
    await page.getByText(/Uploading the video: [1-9]\d?%/).waitFor();
    await expect.poll(() => start(page).isDisabled()).toBe(true); // two at once would take the upload from one another
    await page.getByRole('button', { name: 'Pause', exact: true }).click();
    await page.getByText(/Paused while uploading the video/).waitFor();
    const halted = await share(page);
    await page.waitForTimeout(1500);
    await expect.poll(() => share(page)).toBe(halted);
    await speed(-1);
    await page.getByRole('button', { name: 'Resume', exact: true }).click();
    const kept = page.getByRole('radio', { name: /^Man grimace d0/ });
    await kept.waitFor();
    await expect.poll(() => kept.isChecked()).toBe(true);
  });

  it('stops when told to, and leaves nothing to go on with', async ({ skip }) => {
    const video = media('driving/man_grimace_d0.mp4') ?? skip('the shared test media are not here');
    const { page } = await chosen(video);
    await start(page).click();
    await page.getByText(/Uploading the video: [1-9]\d?%/).waitFor();
    const gone = page.waitForRequest((request) => request.method() === 'DELETE' && request.url().includes('/v1/uploads/'));
    await page.getByRole('button', { name: 'Stop' }).click();
    await gone;
    await start(page).waitFor();
    await page.reload();
    await nothingToResume(page);
  });
});

/** What the page of a finished character opens on: the person stepping out of the picture, with the video at hand. */

import './nobody_works';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints, expectComplaint } from './complaints';
import { launch } from './browser';
import { lacks } from './lacks';
import { address } from './own_service';
import { open } from './page';
import { aViewer, drawings, mode, ready } from './viewer_kit';

const { job, countDrawings } = aViewer();
/** Graphics without a card cost by the pixel. */
const few = { deviceScaleFactor: 0.5 };
let flat: Browser;
let deep: Browser;
beforeAll(async () => {
  [flat, deep] = await Promise.all([launch(['--disable-3d-apis']), launch(['--enable-unsafe-swiftshader'])]);
});
afterAll(async () => {
  await Promise.all([flat.close(), deep.close()]);
});
afterEach(async () => {
  for (const context of [...flat.contexts(), ...deep.contexts()]) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const pressed = (page: Page, name: string) => page.getByRole('button', { name, exact: true, pressed: true });
const film = (page: Page) => page.getByRole('region', { name: 'Result' });

describe('the page of a character', () => {
  it('opens on the wall, where it plays by itself; the video is one click away', async () => {
    const page = await open(deep, `#/jobs/${job()}`, few);
    await page.getByRole('button', { name: 'Pause' }).waitFor();
    await lacks(film(page), pressed(page, 'On the wall'));
    const others = page.getByRole('group', { name: 'What to do' }).getByRole('button');
    await expect.poll(() => others.allTextContents()).toEqual(['On the wall', 'Look around', 'Change the pose', 'Video']);

    await mode(page, 'Video').click();
    await page.waitForFunction(() => (document.querySelector('video')?.currentTime ?? 0) > 0.2);
    await page.locator('canvas').waitFor({ state: 'hidden' });
    await mode(page, 'On the wall').click();
    await lacks(film(page), pressed(page, 'On the wall'));
    await page.getByRole('button', { name: 'Pause' }).waitFor();
    await page.locator('canvas').waitFor();
  });

  it('comes whole: what stands below the result is not pushed away by what comes later', async () => {
    const revision = { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: '{"corrections": {}, "options": {"motion": "bow"}}' };
    const made = await fetch(`${address}/v1/jobs/${job()}/revisions`, revision);
    await fetch(`${address}/v1/jobs/${((await made.json()) as { id: string }).id}/cancel`, { method: 'POST' });
    const page = await open(deep, '', { reducedMotion: 'reduce', ...few });
    let release: () => void = () => undefined;
    const held = new Promise<void>((done) => (release = done));
    await page.route('**/character.glb*', (route) => held.then(() => route.continue()));
    for (const slow of ['**/revisions', '**/report.json*']) {
      await page.route(slow, (route) => new Promise((wake) => setTimeout(wake, 300)).then(() => route.continue()));
    }
    await page.evaluate((id) => (location.hash = `#/jobs/${id}`), job());
    const first = await page.waitForFunction(() => {
      const below = document.querySelector('details.revise');
      return below && { top: below.getBoundingClientRect().top + scrollY, versions: document.querySelectorAll('nav.versions a').length };
    });
    const { top, versions } = (await first.jsonValue())!;
    expect(versions).toBe(2);
    release();
    await page.getByRole('button', { name: 'Play' }).waitFor();
    await expect.poll(() => page.locator('details.revise').evaluate((below) => below.getBoundingClientRect().top + scrollY)).toBe(top);
  });

  it('stands still for who wants it so, until it is played', async () => {
    const page = await open(deep, `#/jobs/${job()}`, { reducedMotion: 'reduce', ...few }, countDrawings);
    await ready(page);
    await pressed(page, 'On the wall').waitFor();
    const before = await drawings(page);
    await page.getByRole('button', { name: 'Play' }).click();
    await page.waitForFunction((so) => window.drawn > so, before);
  });

  it('is shown so on the phone of whoever was sent a link, under its title', async () => {
    await fetch(`${address}/v1/jobs/${job()}`, {
      method: 'PATCH',
      headers: { 'Content-Type': 'application/json' },
      body: JSON.stringify({ title: 'Out for a walk' }),
    });
    const page = await open(flat, `#/jobs/${job()}`);
    await page.getByRole('button', { name: 'Share', exact: true }).click();
    await page.getByRole('button', { name: 'Create link' }).click();
    const link = new URL(await page.getByLabel('Link', { exact: true }).inputValue());
    await page.close();

    const phone = await open(deep, link.hash, { viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true, ...few });
    await phone.getByRole('heading', { name: 'Out for a walk' }).waitFor();
    await phone.getByRole('button', { name: 'Pause' }).waitFor();
    await lacks(mode(phone, 'Change the pose'), pressed(phone, 'On the wall'));
    for (const name of ['Download 3D character', 'USDZ for iPhone', 'Download video']) {
      await phone.getByRole('link', { name }).waitFor();
    }
    await mode(phone, 'Video').click();
    await phone.waitForFunction(() => (document.querySelector('video')?.currentTime ?? 0) > 0.2);
    await phone.getByRole('button', { name: 'View in your space' }).click();
    await phone.waitForFunction(() => document.querySelector('model-viewer')?.loaded);
  });

  it('shows the video at once where there is no 3D', async () => {
    const page = await open(flat, `#/jobs/${job()}`);
    await page.getByText('This browser shows no 3D').waitFor();
    await page.waitForFunction(() => (document.querySelector('video')?.currentTime ?? 0) > 0.2);
    await pressed(page, 'Video').waitFor();
    await expect.poll(() => mode(page, 'On the wall').isDisabled()).toBe(true);
    expectComplaint(/WebGL/);
  });
});

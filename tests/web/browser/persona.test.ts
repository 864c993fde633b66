/** Personas in the page: photos chosen, ordered once somebody has agreed, followed, looked at, made again, and played anew. */

import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page, Request } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { readable } from './axe';
import { launch } from './browser';
import { complaints, watch } from './complaints';
import { LONG_WITH_COMPILING } from './jobs';
import { inPython } from './media';
import { serve } from './service';
import { settled } from './settled';

const folder = mkdtempSync(join(tmpdir(), 'galatea-persona-'));
const letter = { name: 'letter.txt', mimeType: 'text/plain', buffer: Buffer.from('Dear aunt, here are the photos.') };

let browser: Browser;
let service: Awaited<ReturnType<typeof serve>>;
let photos: string[];
beforeAll(async () => {
  inPython('import sys; from pathlib import Path; from engine.persona.sample import write_sample_photos as w; w(Path(sys.argv[1]))', folder);
  photos = readdirSync(folder).sort().map((name) => join(folder, name));
  browser = await launch(['--enable-unsafe-swiftshader']);
  service = await serve({ GALATEA_WORKER_KINDS: 'persona', GALATEA_DISK_RESERVE_MB: '1' });
}, LONG_WITH_COMPILING);
afterAll(async () => {
  await service?.end();
  await browser?.close();
  rmSync(folder, { recursive: true });
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

async function studio(): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, reducedMotion: 'reduce' });
  watch(page);
  await page.goto(`${service.address}/#/persona`);
  return page;
}

const isPost = (ending: RegExp) => (request: Request) => request.method() === 'POST' && ending.test(request.url());
const jobOf = (page: Page): string => page.url().split('/').at(-1) ?? '';
/** A job that was ordered for what it asks for is not waited for. */
const cancel = async (request: Request): Promise<void> => {
  const { id } = (await (await request.response())!.json()) as { id: string };
  await fetch(`${service.address}/v1/jobs/${id}/cancel`, { method: 'POST' });
};

describe('photos of somebody', () => {
  it('become a persona that plays, is made again without a face, and plays something else', async () => {
    const page = await studio();
    const start = page.getByRole('button', { name: 'Create persona' });
    await page.getByLabel(/^Drop photos, a folder/).setInputFiles(photos);
    const tiles = page.getByRole('list', { name: 'The files that were chosen' }).getByRole('listitem');
    await expect.poll(() => tiles.count()).toBe(photos.length);
    // what is there already is not there twice, and what is no photo is told
    await page.getByLabel(/^Drop more photos here/).setInputFiles([photos[0]!]);
    await expect.poll(() => tiles.count()).toBe(photos.length);
    await page.getByRole('button', { name: /^Remove 00-/ }).press('Enter');
    await expect.poll(() => tiles.count()).toBe(photos.length - 1);
    await expect.poll(() => page.evaluate(() => document.activeElement?.getAttribute('aria-label'))).toMatch(/^Remove 01-/);
    await expect.poll(() => start.isDisabled()).toBe(true);
    await page.getByLabel('The photos show me, or somebody who agreed to this.').check();
    await page.getByRole('radio', { name: 'Happy' }).press(' ');
    await page.getByRole('button', { name: 'The face alone' }).click();
    await readable(page);
    await page.getByText('Options', { exact: true }).click();
    await page.getByLabel('Background').fill('#102030');
    const [request] = await Promise.all([page.waitForRequest(isPost(/\/v1\/jobs$/)), start.click()]);
    const asked = request.postDataJSON() as { inputs: { photos: string[]; driver: string } };
    expect(asked).toMatchObject({ kind: 'persona', inputs: { driver: 'happy' }, options: { background: [16, 32, 48] } });
    expect(asked.inputs.photos).toHaveLength(photos.length - 1);

    const faces = page.getByRole('region', { name: 'The faces that were found' });
    await faces.getByRole('img', { name: /^\d+ faces are used$/ }).waitFor({ timeout: LONG_WITH_COMPILING });
    await page.getByAltText('The average of the photos so far').waitFor();
    await page.getByRole('region', { name: 'Result and performance' }).waitFor({ timeout: LONG_WITH_COMPILING });
    const made = jobOf(page);
    await readable(page);
    await page.getByRole('button', { name: 'In 3D', exact: true }).click();
    const stage = page.locator('.viewer-stage[aria-busy="false"]');
    await stage.waitFor();
    const seen = async (): Promise<string> => (await stage.screenshot()).toString('base64');
    const calm = await settled(seen);
    await page.getByRole('region', { name: 'Expressions' }).getByRole('button', { name: 'Surprise' }).click();
    await expect.poll(seen).not.toBe(calm);
    await readable(page);
    await page.getByRole('button', { name: 'Expressions', exact: true }).click();
    await page.getByRole('img', { name: 'At rest' }).waitFor();
    await page.getByRole('button', { name: 'Average', exact: true }).click();
    await page.getByAltText('The average face of all photos').waitFor();
    await page.getByRole('button', { name: 'Faces', exact: true }).click();
    await faces.waitFor();

    await page.getByText('Edit and make again').click();
    const used = page.getByRole('toolbar', { name: /^\d+ faces are used$/ }).getByRole('button');
    await used.first().click();
    await used.first().press('ArrowRight');
    await expect.poll(() => used.nth(1).evaluate((button) => button === document.activeElement)).toBe(true);
    await page.getByText(/You decided about one face\./).waitFor();
    await expect.poll(() => used.first().getAttribute('aria-pressed')).toBe('false');
    await readable(page);
    const [revision] = await Promise.all([
      page.waitForRequest(isPost(/\/revisions$/)),
      page.getByRole('button', { name: 'Make it again' }).click(),
    ]);
    expect((revision.postDataJSON() as { corrections: object }).corrections).toEqual({ leave_out: [expect.any(Number)] });
    await cancel(revision);

    await page.goto(`${service.address}/#/jobs/${made}`);
    const [again] = await Promise.all([
      page.waitForRequest(isPost(/\/v1\/jobs$/)),
      page.getByRole('region', { name: 'Let it play another performance' }).getByRole('button', { name: 'Wink' }).click(),
    ]);
    expect(again.postDataJSON()).toMatchObject({ inputs: { persona: made, driver: 'wink' }, options: { background: [16, 32, 48] } });
    await cancel(again);

    await page.goto(`${service.address}/#/jobs/${made}`);
    await page.getByRole('link', { name: 'Play a video of your own' }).click();
    await expect.poll(() => page.getByRole('radio', { name: '27 photos' }).isChecked()).toBe(true);
    await readable(page);
  });

  it('that are too few are told with the faces that were found, and more can be added', async () => {
    const page = await studio();
    await page.getByLabel(/^Drop photos, a folder/).setInputFiles(photos.slice(0, 4));
    await page.getByText('4 files').waitFor();
    await page.getByLabel('The photos show me, or somebody who agreed to this.').check();
    await page.getByRole('button', { name: 'Create persona' }).click();
    await page.getByText('There are too few photos of use').waitFor({ timeout: LONG_WITH_COMPILING });
    await page.getByRole('toolbar', { name: /faces? (is|are) used$/ }).waitFor();
    await readable(page);
    await page.getByRole('link', { name: 'Add photos in the studio' }).click();
    await expect.poll(() => page.getByRole('list', { name: 'The files that were chosen' }).getByRole('listitem').count()).toBe(4);
  });

  it('are asked for where there is none among the files', async () => {
    const page = await studio();
    await page.getByLabel(/^Drop photos, a folder/).setInputFiles([letter]);
    await page.getByText(/^There is no photo among these/).waitFor();
    await expect.poll(() => page.getByRole('button', { name: 'Create persona' }).isDisabled()).toBe(true);
  });
});

/** Avatars in the page: ordered once somebody has agreed, followed, looked at, and made again; against a service that fits nothing. */

import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import type { Browser, Page, Request } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { readable } from './axe';
import { launch } from './browser';
import { complaints, watch } from './complaints';
import { ended, LONG, submit } from './jobs';
import { lacks } from './lacks';
import { fileOf, inPython } from './media';
import { serve } from './service';
import { settled } from './settled';

const root = resolve(import.meta.dirname, '../../..');
const folder = mkdtempSync(join(tmpdir(), 'galatea-avatar-'));
const clip = join(folder, 'me.mp4');

let browser: Browser;
let service: Awaited<ReturnType<typeof serve>>;
/** Of a finished avatar of 1.75 metres, and of one that failed for want of joints. */
let finished: string;
let failed: string;
beforeAll(async () => {
  // a camera that goes past a wall of coloured blocks
  inPython(
    `
import sys
import av, numpy as np
wall = np.random.default_rng(5).integers(60, 256, (36, 48, 3), np.uint8).repeat(8, 0).repeat(8, 1)
with av.open(sys.argv[1], "w") as film:
    stream = film.add_stream("libx264", rate=25)
    stream.width, stream.height, stream.pix_fmt = 160, 288, "yuv420p"
    for k in range(60):
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(wall[:, 3 * k : 3 * k + 160]))
        film.mux(stream.encode(frame))
    film.mux(stream.encode())
`,
    clip,
  );
  browser = await launch(['--enable-unsafe-swiftshader']);
  service = await serve({
    GALATEA_KINDS: 'template_avatar_kind:KIND',
    GALATEA_DISK_RESERVE_MB: '1',
    PYTHONPATH: [resolve(root, 'tests/live_service'), root].join(':'),
  });
  const order = (height_m: number) => submit(service.address, 'avatar', { body: fileOf(clip), head: fileOf(clip) }, { height_m });
  [finished, failed] = [await order(1.75), await order(0.9)];
  await ended(service.address, finished);
  await ended(service.address, failed, 'failed');
}, LONG);
afterAll(async () => {
  await service?.end();
  await browser?.close();
  rmSync(folder, { recursive: true });
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

async function opened(hash: string): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, reducedMotion: 'reduce' });
  watch(page);
  await page.goto(`${service.address}/${hash}`);
  return page;
}

const isPost = (ending: RegExp) => (request: Request) => request.method() === 'POST' && ending.test(request.url());

describe('the studio of avatars', () => {
  it('orders once it was said that the person agreed, and asks for what was chosen', async () => {
    const page = await opened('#/avatar');
    const start = page.getByRole('button', { name: 'Create avatar' });
    await page.getByLabel(/Drop the body clip/).setInputFiles(clip);
    await page.getByLabel('Height').fill('175');
    await page.getByText('Confirm that the person agreed to it.').waitFor();
    await expect.poll(() => start.isDisabled()).toBe(true);
    await page.getByLabel('The clips show me, or somebody who agreed to this.').check();
    await expect.poll(() => start.isDisabled()).toBe(false);
    // other clips may show somebody else
    await page.getByLabel(/^Body clip: me.mp4/).setInputFiles(clip);
    await expect.poll(() => start.isDisabled()).toBe(true);
    await page.getByLabel('The clips show me, or somebody who agreed to this.').check();
    const further = page.getByRole('region', { name: 'Further clips' });
    await further.getByText('Further clips').click();
    await further.getByLabel(/^Drop a further clip/).setInputFiles(clip);
    await further.getByLabel(/^Drop another clip/).setInputFiles({ name: 'hands.mp4', mimeType: 'video/mp4', buffer: readFileSync(clip) });
    await expect.poll(() => start.isDisabled()).toBe(true);
    await page.getByLabel('The clips show me, or somebody who agreed to this.').check();
    await further.getByRole('button', { name: 'Remove the clip me.mp4' }).click();
    await expect.poll(() => start.isDisabled()).toBe(false);
    await page.getByRole('radio', { name: 'Dance' }).press(' ');
    await page.getByText('Options').click();
    await page.getByLabel('Also as VRM').check();
    await readable(page);
    const [request] = await Promise.all([page.waitForRequest(isPost(/\/v1\/jobs$/)), start.click()]);
    const asked = request.postDataJSON() as { inputs: Record<string, string | string[]>; options: object };
    expect(asked).toMatchObject({ kind: 'avatar', options: { height_m: 1.75, vrm: true } });
    expect(Object.keys(asked.inputs).sort()).toEqual(['body', 'more', 'motion']);
    expect(asked.inputs.more).toHaveLength(1);
    expect(asked.inputs.motion).toBe('dance');
    await page.getByRole('heading', { name: 'Me', level: 1 }).waitFor();
    await fetch(`${service.address}/v1/jobs/${page.url().split('/').at(-1)}/cancel`, { method: 'POST' });
  });
});

describe('a finished avatar', () => {
  it('stands there, makes the faces that are chosen, and shows what was measured', async () => {
    const page = await opened(`#/jobs/${finished}`);
    const stage = page.locator('.viewer-stage[aria-busy="false"]');
    await stage.waitFor();
    const faces = page.getByRole('region', { name: 'Expressions' });
    const seen = async (): Promise<string> => (await stage.screenshot()).toString('base64');
    const whole = await settled(seen);
    await faces.getByRole('button', { name: 'Close-up' }).click();
    await expect.poll(seen).not.toBe(whole);
    const calm = await settled(seen);
    await faces.getByRole('button', { name: 'Surprise' }).click();
    await expect.poll(seen).not.toBe(calm);
    await faces.getByRole('button', { name: 'Reset face' }).click();
    await expect.poll(seen).toBe(calm);
    const blink = faces.getByRole('slider', { name: 'Eye blink, left' });
    await blink.press('End');
    await expect.poll(() => blink.getAttribute('aria-valuetext')).toBe('100%');
    await expect.poll(seen).not.toBe(calm);
    await readable(page);

    await page.getByRole('button', { name: 'Measured', exact: true }).click();
    await page.getByText(/^13,\d+ of the measured points/).waitFor();
    await page.getByAltText('Frames chosen from the head clip').waitFor();
    const points = page.getByRole('application', { name: /^The measured points in 3D/ });
    const measured = await settled(async () => (await points.screenshot()).toString('base64'));
    await page.getByLabel('Show the fitted shape instead of the points').check();
    await expect.poll(async () => (await points.screenshot()).toString('base64')).not.toBe(measured);
    await page.getByRole('link', { name: /^Download avatar \(GLB\)/ }).waitFor();
  });

  it('is made again without a frame, and taller', async () => {
    const page = await opened(`#/jobs/${finished}`);
    await page.getByText('Edit and make again').click();
    const frames = page.getByRole('region', { name: 'Frames of the body clip' }).getByRole('button', { name: /^Frame/ });
    await frames.nth(2).click();
    await page.getByText('One frame is left out.').waitFor();
    await page.getByLabel('Height').fill('1,80 m');
    await readable(page);
    const [request] = await Promise.all([
      page.waitForRequest(isPost(/\/revisions$/)),
      page.getByRole('button', { name: 'Make it again' }).click(),
    ]);
    const { corrections } = request.postDataJSON() as { corrections: { body_frames_left_out: number[] } };
    expect(corrections).toMatchObject({ height_m: 1.8 });
    expect(corrections.body_frames_left_out).toHaveLength(1);
    expect((await request.response())?.status()).toBe(202);
  });
});

describe('an avatar that is being made', () => {
  it('shows its shape and its texture on the way', async () => {
    const giant = await submit(service.address, 'avatar', { body: fileOf(clip) }, { height_m: 2.4 });
    const page = await opened(`#/jobs/${giant}`);
    await expect.poll(() => page.getByLabel('Show the fitted shape instead of the points').isChecked()).toBe(true);
    await page.locator('.viewer-stage[aria-busy="false"]').waitFor();
    await page.getByAltText('The texture, as it was stitched from the frames').waitFor();
    await readable(page);
    await fetch(`${service.address}/v1/jobs/${giant}/cancel`, { method: 'POST' });
  });
});

describe('an avatar that was made before', () => {
  it('does something else, and nobody is asked how tall it is', async () => {
    const small = { size: [96, 160], seconds: 1, fps: 5 };
    const id = await submit(service.address, 'avatar', { avatar: finished, motion: 'wave' }, small);
    await ended(service.address, id);
    const page = await opened(`#/jobs/${id}`);
    await page.locator('.viewer-stage[aria-busy="false"]').waitFor();
    await page.getByText('Edit and make again').click();
    await page.locator('form.corrections').getByLabel('Motion', { exact: true }).selectOption('name dance');
    await lacks(page.getByLabel('Height'), page.getByRole('button', { name: 'Make it again' }));
    const [request] = await Promise.all([
      page.waitForRequest(isPost(/\/revisions$/)),
      page.getByRole('button', { name: 'Make it again' }).click(),
    ]);
    const answer = await request.response();
    expect(answer?.status()).toBe(202);
    await ended(service.address, ((await answer?.json()) as { id: string }).id);
  });
});

describe('an avatar without joints', () => {
  it('is made again with those that are shown in two frames', async () => {
    const page = await opened(`#/jobs/${failed}`);
    await page.getByText('In doubt: Left elbow, Right knee.').waitFor();
    await page.getByRole('button', { name: 'Place joints' }).click();
    const stage = page.getByRole('application', { name: /Left elbow/ });
    for (const frame of [0, 6]) {
      await page.getByRole('slider', { name: 'Frame' }).fill(String(frame));
      const { width, height } = (await stage.boundingBox())!;
      await stage.click({ position: { x: width / 4, y: height / 2 } });
    }
    await page.getByRole('button', { name: 'Apply' }).click();
    await page.getByText('One joint is placed by hand.').waitFor();
    const [request] = await Promise.all([
      page.waitForRequest(isPost(/\/revisions$/)),
      page.getByRole('button', { name: 'Make it again' }).click(),
    ]);
    const { corrections } = request.postDataJSON() as { corrections: { landmarks: Record<string, { place: [number, number] }[]> } };
    const places = corrections.landmarks.LeftElbow!;
    expect(places).toHaveLength(2);
    for (const { place } of places) {
      expect(Math.abs(place[0] - (160 / 4 - 0.5))).toBeLessThan(1.5);
      expect(Math.abs(place[1] - (288 / 2 - 0.5))).toBeLessThan(1.5);
    }
    expect((await request.response())?.status()).toBe(202);
  });
});

import './portraits_only';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, describe, expect, it } from 'vitest';
import { readable } from './axe';
import { launch } from './browser';
import { complaints } from './complaints';
import { lacks } from './lacks';
import { inPython } from './media';
import { ask, jobOf, open } from './page';

let browser: Browser | undefined;
const folder = mkdtempSync(join(tmpdir(), 'galatea-live-'));
afterAll(() => rmSync(folder, { recursive: true, force: true }));
afterEach(async () => {
  await browser?.close();
  expect(complaints.splice(0)).toEqual([]);
});

/** The built-in performance of surprise, as a camera that Chromium takes for a real one: a second and a half of calm, and on. */
const CAMERA = `
import sys, av
from fractions import Fraction
from engine.performances import video
with av.open(str(video("surprise"))) as reading, av.open(sys.argv[1], "w", format="mjpeg") as writing:
    camera = writing.add_stream("mjpeg", rate=25, options={"q:v": "4"})
    camera.width, camera.height, camera.pix_fmt = 480, 480, "yuvj420p"
    frames = [frame.reformat(480, 480, "yuvj420p") for frame in reading.decode(video=0)]
    for number, frame in enumerate([frames[0]] * 75 + frames):
        frame.pts, frame.time_base = number, Fraction(1, 25)
        writing.mux(camera.encode(frame))
    writing.mux(camera.encode())
`;

/** What the picture on a page's canvas looks like: a few of its pixels, as one text. */
const shown = (page: Page): Promise<string> =>
  page.evaluate(() => {
    const canvas = document.querySelector('canvas');
    const small = new OffscreenCanvas(24, 24).getContext('2d');
    if (!canvas || !small || canvas.width < 16) return '';
    small.drawImage(canvas, 0, 0, 24, 24);
    return small.getImageData(0, 0, 24, 24).data.join();
  });

describe('a live portrait', () => {
  it('follows the camera, is seen alone elsewhere, and a take becomes a job', async () => {
    const camera = join(folder, 'face.mjpeg');
    inPython(CAMERA, camera);
    browser = await launch([
      '--use-fake-device-for-media-stream',
      '--use-fake-ui-for-media-stream',
      `--use-file-for-fake-video-capture=${camera}`,
    ]);
    const page = await open(browser);
    await expect.poll(() => page.getByRole('button', { name: 'Drive live' }).isDisabled()).toBe(true);
    await page.getByRole('button', { name: /^Grace Hopper/ }).click();
    await page.getByLabel('Portrait: Grace Hopper.jpg. Choose another').waitFor({ state: 'attached' });
    await page.getByRole('button', { name: 'Drive live' }).click();
    await page.getByText('Live. Move, speak, smile.').waitFor();
    await expect.poll(() => shown(page)).not.toBe('');
    const still = await shown(page);
    await expect.poll(() => shown(page)).not.toBe(still);
    await readable(page);
    await page.setViewportSize({ width: 1280, height: 900 });

    const alone = page.getByRole('link', { name: 'Picture alone' });
    const viewer = await browser.newPage();
    await viewer.goto(new URL((await alone.getAttribute('href')) ?? '', page.url()).href);
    await expect.poll(() => shown(viewer)).not.toBe('');
    await lacks(viewer.locator('header, footer, nav'), viewer.locator('canvas'));
    const ground = () => viewer.evaluate(() => getComputedStyle(document.querySelector('.live-alone')!).backgroundColor);
    await expect.poll(ground).toBe('rgb(0, 0, 0)');
    await viewer.close();

    await page.getByRole('button', { name: 'Record', exact: true }).click();
    await page.getByText(/^0:0[2-9]$/).waitFor();
    await page.getByRole('button', { name: 'Stop and keep' }).click();
    await page.getByRole('heading', { name: /Grace Hopper/ }).waitFor();
    const job = await ask<{ kind: string; metadata: { performance: string } }>(`/v1/jobs/${jobOf(page)}`);
    expect(job).toMatchObject({ kind: 'portrait', metadata: { performance: 'My live take' } });
  });
});

import './portraits_only';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser } from 'playwright-core';
import { afterAll, afterEach, describe, expect, it } from 'vitest';
import { complaints } from './complaints';
import { launch } from './browser';
import { inPython, media } from './media';
import { ask, jobOf, open, played } from './page';

let browser: Browser | undefined;
const folder = mkdtempSync(join(tmpdir(), 'galatea-camera-'));
afterAll(() => rmSync(folder, { recursive: true, force: true }));
afterEach(async () => {
  await browser?.close();
  expect(complaints.splice(0)).toEqual([]);
});

/** Two seconds of a video as a camera that Chromium takes for a real one. */
const CAMERA = `
import sys, av
from fractions import Fraction
source, out = sys.argv[1:]
with av.open(source) as reading, av.open(out, "w", format="mjpeg") as writing:
    camera = writing.add_stream("mjpeg", rate=25, options={"q:v": "4"})
    camera.width, camera.height, camera.pix_fmt = 480, 480, "yuvj420p"
    for number, frame in enumerate(reading.decode(video=0)):
        if number == 50:
            break
        frame = frame.reformat(480, 480, "yuvj420p")
        frame.pts, frame.time_base = number, Fraction(1, 25)
        writing.mux(camera.encode(frame))
    writing.mux(camera.encode())
`;

describe('the camera', () => {
  it('gives the portrait and the performance, in the format that the browser has', async ({ skip }) => {
    const face = media('driving/man_grimace_d0.mp4') ?? skip('the shared test media are not here');
    const camera = join(folder, 'face.mjpeg');
    inPython(CAMERA, face, camera);
    browser = await launch([
      '--use-fake-device-for-media-stream',
      '--use-fake-ui-for-media-stream',
      `--use-file-for-fake-video-capture=${camera}`,
    ]);
    const page = await open(browser);
    // As in a browser that records nothing but WebM.
    await page.evaluate(() => {
      const all = MediaRecorder.isTypeSupported.bind(MediaRecorder);
      MediaRecorder.isTypeSupported = (type) => !type.includes('mp4') && all(type);
    });

    await page.getByRole('button', { name: 'Take a picture' }).click();
    await page.getByRole('button', { name: 'Take the picture' }).click();
    await page.getByRole('img', { name: 'The picture that was taken' }).waitFor();
    await page.getByRole('button', { name: 'Take again' }).click();
    await page.getByRole('button', { name: 'Take the picture' }).click();
    await page.getByRole('button', { name: 'Use this picture' }).click();
    await page.getByLabel('Portrait: My picture.jpg. Choose another').waitFor();
    await expect.poll(() => page.evaluate(() => document.activeElement?.textContent)).toContain('Take a picture');

    await page.getByRole('button', { name: 'Record yourself' }).click();
    await page.getByRole('button', { name: 'Record', exact: true }).click();
    await page.getByText('Recording.', { exact: true }).waitFor();
    await page.getByText(/^0:(0[2-9]|[1-5]\d) \/ 3:00$/).waitFor();
    await page.getByRole('button', { name: 'Stop recording' }).click();
    await page.getByLabel('Your recording').waitFor();
    await page.getByRole('button', { name: 'Use this recording' }).click();
    await page.getByLabel('Video: My performance.webm. Choose another').waitFor();

    await page.getByRole('button', { name: 'Bring it to life' }).click();
    await page.getByRole('heading', { name: 'My picture' }).waitFor();
    await played(page);
    await page.getByLabel('Position').fill('1');
    await page.waitForFunction(() => {
      const [result, driver] = Array.from(document.querySelectorAll('video'));
      return result && driver && !driver.seeking && Math.abs(result.currentTime - driver.currentTime) < 0.12;
    });
    const job = await ask<{ inputs: { driver: string } }>(`/v1/jobs/${jobOf(page)}`);
    expect(await ask(`/v1/files/${job.inputs.driver}`)).toMatchObject({ content_type: 'video/webm' });
  });

  it('is missed in plain words', async () => {
    browser = await launch();
    const page = await open(browser);
    await page.getByRole('button', { name: 'Take a picture' }).click();
    const alert = page.getByRole('alert');
    await alert.waitFor();
    await expect.poll(() => alert.innerText()).toMatch(/Connect a camera|Allow this page/);
    await page.keyboard.press('Escape');
    await alert.waitFor({ state: 'detached' });
  });
});

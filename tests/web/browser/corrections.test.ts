import './portraits_only';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { canonical } from '@web/kinds/portrait/landmarks/template';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints } from './complaints';
import { accepted, revised } from './character_kit';
import { launch } from './browser';
import { LONG } from './jobs';
import { lacks } from './lacks';
import { inPython, inPythonBeside, portrait } from './media';
import { onScreen } from './on_screen';
import { finished } from './own_service';
import { ask, jobOf, open, order, played } from './page';

type Points = [number, number][];
interface Landmarks {
  landmarks: Points;
}

/** The portrait, half as large, and a smaller mirrored one to its right. */
const TWO = `
import sys
from PIL import Image, ImageOps
one = Image.open(sys.argv[1]).convert("RGB").reduce(2)
other = ImageOps.mirror(one).resize((one.width * 3 // 4, one.height * 3 // 4))
both = Image.new("RGB", (one.width + other.width, one.height), (90, 90, 90))
both.paste(one, (0, 0))
both.paste(other, (one.width, 0))
both.save(sys.argv[2])
print(one.width)
`;

const folder = mkdtempSync(join(tmpdir(), 'galatea-two-'));
let browser: Browser;
let border: number;
let done: string;
beforeAll(async () => {
  browser = await launch();
  border = Number(await inPythonBeside(TWO, portrait, join(folder, 'two.png')));
  done = await order(join(folder, 'two.png'), 'happy');
});
afterAll(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const stage = (page: Page) => page.getByRole('application');
const again = (page: Page) => page.getByText('Edit and make again');
const landmarks = (id: string): Promise<Landmarks> => ask(`/v1/jobs/${id}/artifacts/landmarks.json`);
const xs = (points: Points): number[] => points.map(([x]) => x);

describe('corrections by hand', () => {
  it('begin with the canonical face of the engine', () => {
    const engine = inPython(
      'import json, numpy as np; from engine.perception.face.head_pose import canonical_face as f; ' +
        'from engine.perception.face.landmarks import fiducials as g; ' +
        'print(json.dumps(np.round(g(f().astype(float))[:, :2], 3).tolist()))',
    );
    expect(JSON.parse(engine)).toEqual(canonical);
  });

  it('choose another face by a click', async () => {
    const page = await open(browser, `#/jobs/${done}`);
    await page.getByRole('region', { name: 'Result and performance' }).waitFor({ timeout: LONG });
    expect(Math.max(...xs((await landmarks(done)).landmarks))).toBeLessThan(border);
    await again(page).click();
    await page.getByText('2 faces were found.').waitFor();
    const other = page.getByRole('button', { name: 'Face 2 of 2' });
    await other.click();
    await expect.poll(() => other.getAttribute('aria-pressed')).toBe('true');
    await page.getByRole('button', { name: 'Make it again' }).click();
    await page.waitForURL((url) => !url.hash.endsWith(done));
    await played(page);
    const id = jobOf(page);
    expect(Math.min(...xs((await landmarks(id)).landmarks))).toBeGreaterThan(border);
  });

  it('use a part of the performance, whose calm frame is then found by itself, and make another kind of video', async () => {
    const page = await open(browser, `#/jobs/${done}`);
    await again(page).click({ timeout: LONG });
    await page.getByLabel('Seamless loop').check();
    await page.getByLabel('Turn the head in 3D').uncheck();
    const calm = page.getByRole('slider', { name: 'Neutral frame' });
    await calm.fill('3');
    await page.getByRole('spinbutton', { name: 'From' }).fill('0.5');
    await page.keyboard.press('Tab');
    await calm.waitFor({ state: 'detached' });
    await page.getByRole('button', { name: 'Make it again' }).click();
    const to = page.getByRole('spinbutton', { name: 'To' });
    await expect.poll(() => to.evaluate((input: HTMLInputElement) => input.validity.valueMissing)).toBe(true);
    await to.fill('1.25');
    await page.keyboard.press('Tab');
    await page.getByLabel('Frames per second').selectOption('25');
    await page.getByLabel('File format').selectOption('WebM');
    await lacks(page.getByLabel('Face in the video'), page.getByLabel('File format')); // it shows one face alone
    const request = await revised(page);
    const { options } = request.postDataJSON();
    expect(Object.fromEntries(Object.entries(options).filter(([, value]) => value !== null))).toEqual({
      ...{ loop: true, head_3d: false, trim: [0.5, 1.25], fps: 25, format: 'webm' },
    });
    await accepted(request);
  });

  it('name another face of the performance, where it has not so many', async () => {
    const id = await order(portrait, 'happy', { driver_face_index: 1 });
    const page = await open(browser, `#/jobs/${id}`);
    await page.getByText('There are fewer faces in the performance').waitFor({ timeout: LONG });
    await page.getByLabel('Face in the video').selectOption('The largest face');
    const request = await revised(page);
    expect(request.postDataJSON().options.driver_face_index).toBe(null);
    await accepted(request);
  });

  it('move a feature by a drag, and a point by the keyboard, and are undone', async () => {
    const page = await open(browser, `#/jobs/${done}`);
    await again(page).click({ timeout: LONG });
    const before = (await landmarks(done)).landmarks;
    await page.getByRole('button', { name: 'Move the landmarks' }).click();
    await stage(page).waitFor();

    const [from, to] = await onScreen(page, [before[66], [before[66]![0] + 6, before[66]![1] + 3]] as Points);
    await page.mouse.move(from![0], from![1]);
    await page.mouse.down();
    await page.mouse.move((from![0] + to![0]) / 2, (from![1] + to![1]) / 2);
    await page.mouse.move(to![0], to![1]);
    await page.mouse.up();
    await page.getByRole('status').getByText('Lips', { exact: true }).waitFor({ state: 'attached' });

    await page.getByLabel('Moves').selectOption('Left eye');
    await page.getByLabel('Single points').check();
    await page.getByLabel('Move neighbours too').uncheck();
    await stage(page).focus();
    await page.keyboard.press('PageDown');
    await page.getByText('Left eye, point 2 of 6').waitFor({ state: 'attached' });
    for (const key of ['Shift+ArrowUp', 'ArrowLeft', 'Control+z']) await page.keyboard.press(key);
    await page.getByRole('button', { name: 'Apply' }).click();
    await page.getByText('The landmarks were placed by hand.').waitFor();

    const request = await revised(page);
    await page.waitForURL((url) => !url.hash.endsWith(done));
    const job = await ask<{ options: { landmarks: Points } }>(`/v1/jobs/${jobOf(page)}`);
    await accepted(request);
    const after = job.options.landmarks;
    const moves = after.map(([x, y], index) => [x - before[index]![0], y - before[index]![1]] as const);
    moves.forEach(([dx, dy], index) => {
      const lips = index >= 48;
      if (index === 37) return;
      expect(dx).toBeCloseTo(lips ? 6 : 0, 0);
      expect(dy).toBeCloseTo(lips ? 3 : 0, 0);
    });
    expect(moves[37]![0]).toBeCloseTo(0, 1); // that step was undone
    expect(moves[37]![1]).toBeLessThan(-5);
  });

  it('place a face where none was found', async () => {
    const id = finished.noFace;
    const page = await open(browser, `#/jobs/${id}`);
    await page.getByText('Correct and try again').click({ timeout: LONG });
    const again = page.getByRole('button', { name: 'Make it again' });
    await again.waitFor();
    await expect.poll(() => again.isDisabled()).toBe(true); // the same would fail again
    await page.getByRole('button', { name: 'Place the face by hand' }).click();
    await stage(page).focus();
    for (const key of ['+', '+', 'ArrowUp', ']', '[']) await page.keyboard.press(key);
    await page.getByRole('button', { name: 'Apply' }).click();
    await page.getByRole('button', { name: 'Make it again' }).click();
    await page.waitForURL((url) => !url.hash.endsWith(id));
    await played(page);
  });
});

/** A character made by the real service, in the page's viewer, in a real Chromium without a GPU. */

import { readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect, inject } from 'vitest';
import { complaints, watch } from './complaints';
import { ask, inPython, launch, LONG, samplePerson } from './page';
import { buildViewerPage, type Files, openViewer } from './viewer_page';

export const CLIPS = [
  ...['pictured', 'step_out', 'walk', 'walk_in_place'],
  ...['idle', 'run_in_place', 'jump', 'sit', 'wave', 'dance', 'bow'],
];

/** Somebody, and the same once more to the right of them: further away, so smaller, on the same floor of the picture. */
const TWO = `
import sys
from PIL import Image
from engine.character.sample import sample_picture
one = Image.fromarray(sample_picture())
both = Image.new("RGB", (one.width + one.width * 4 // 5, one.height), (128, 138, 148))
both.paste(one, (0, 0))
both.paste(one.resize((one.width * 4 // 5, one.height * 4 // 5)), (one.width, one.height // 5))
both.save(sys.argv[1])
`;

/** Somebody in a deep bend of the knees: all the body is lower, and the feet are where they were. */
const CROUCHING = Object.fromEntries(
  ['Left', 'Right'].flatMap((side) => [
    [`${side}UpLeg`, [-70, 0, 0]],
    [`${side}Leg`, [110, 0, 0]],
    [`${side}Foot`, [-30, 0, 0]],
  ]),
);
const OPTIONS = { one: {}, two: { person_index: 'all' }, crouching: { pose: CROUCHING } };

/** What a file of tests has: called once in it, it sets up a browser and a job, one for all files that ask for the same. */
export function aViewer(of: keyof typeof OPTIONS = 'one') {
  const picture = join(tmpdir(), `galatea-viewer-${process.pid}-${of}.png`);
  let browser: Browser;
  let files: Files;
  let job: string;

  beforeAll(async () => {
    if (of === 'two') inPython(TWO, picture);
    else samplePerson(picture);
    job = await ordered(picture, OPTIONS[of], `viewer-${of}`);
    [browser, files] = await Promise.all([launch(['--enable-unsafe-swiftshader']), buildViewerPage()]);
    await succeeded(job);
  }, LONG);
  afterAll(async () => {
    await browser?.close();
    rmSync(picture, { force: true });
  });
  afterEach(async () => {
    for (const context of browser.contexts()) await context.close();
    expect(complaints.splice(0)).toEqual([]);
  });

  const open = async (options: Parameters<Browser['newPage']>[0] = {}, by = browser): Promise<Page> => {
    const page = await by.newPage({ viewport: { width: 760, height: 1000 }, reducedMotion: 'reduce', ...options });
    watch(page);
    await page.addInitScript(countDrawings);
    await openViewer(page, files, job);
    return page;
  };
  return { open, countDrawings, job: () => job, picture: () => readFileSync(picture) };
}

/** Ordered with one key by all who ask, it is made once. */
async function ordered(picture: string, options: object, key: string): Promise<string> {
  const body = new FormData();
  body.append('kind', 'character');
  body.append('photo', new Blob([readFileSync(picture)]), 'somebody.png');
  body.append('options', JSON.stringify({ seconds: 2, size: [240, 320], ...options }));
  const headers = { 'Idempotency-Key': key };
  const response = await fetch(`${inject('address')}/v1/jobs`, { method: 'POST', body, headers });
  return ((await response.json()) as { id: string }).id;
}

async function succeeded(job: string): Promise<void> {
  const deadline = Date.now() + LONG;
  for (let status = ''; status !== 'succeeded'; await new Promise((wake) => setTimeout(wake, 500))) {
    const told = await ask<{ status: string; error: object | null }>(`/v1/jobs/${job}`);
    status = told.status;
    if (status === 'failed' || Date.now() > deadline) throw new Error(`the character is ${status}: ${JSON.stringify(told.error)}`);
  }
}

/** In the page: how often the graphics are asked to draw. */
function countDrawings(): void {
  const kind = WebGL2RenderingContext?.prototype;
  Object.assign(window, { drawn: 0 });
  for (const name of kind ? (['drawElements', 'drawArrays'] as const) : []) {
    const draw = kind[name] as (...given: unknown[]) => void;
    Object.assign(kind, {
      [name](this: unknown, ...given: unknown[]) {
        (window as unknown as { drawn: number }).drawn++;
        return draw.apply(this, given);
      },
    });
  }
}

/** Until the character stands there and nothing is drawn any more. */
export async function ready(page: Page): Promise<void> {
  await page.locator('.viewer-stage[aria-busy="false"]').waitFor({ timeout: 60_000 });
  await still(page);
}

export const drawings = (page: Page): Promise<number> => page.evaluate(() => (window as unknown as { drawn: number }).drawn);

export async function still(page: Page): Promise<void> {
  for (let before = -1, now = 0; before !== now; ) {
    [before, now] = [now, await drawings(page)];
    await page.waitForTimeout(250);
  }
}

export const shot = (page: Page): Promise<Buffer> => page.locator('.viewer-stage').screenshot();
export const mode = (page: Page, name: string) => page.getByRole('button', { name, exact: true });

/** How many pixels differ between two pictures of one size; by the browser's own decoder. */
export const differing = (page: Page, first: Buffer, second: Buffer): Promise<number> =>
  page.evaluate(
    async (given) => {
      const pixels = async (base64: string) => {
        const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
        const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d')!;
        pen.drawImage(bitmap, 0, 0);
        return pen.getImageData(0, 0, bitmap.width, bitmap.height).data;
      };
      const [one, other] = (await Promise.all(given.map(pixels))) as [Uint8ClampedArray, Uint8ClampedArray];
      let count = 0;
      for (let i = 0; i < one.length; i += 4) {
        const apart = Math.abs(one[i]! - other[i]!) + Math.abs(one[i + 1]! - other[i + 1]!) + Math.abs(one[i + 2]! - other[i + 2]!);
        if (apart > 24) count++;
      }
      return count;
    },
    [first.toString('base64'), second.toString('base64')],
  );

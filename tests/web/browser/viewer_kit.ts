/** A character made by the real service, in the page's viewer, in a real Chromium without a GPU. */

import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, expect } from 'vitest';
import { launch } from './browser';
import { complaints, watch } from './complaints';
import { ended, LIGHT, LONG, orderCharacter, revise } from './jobs';
import { samplePeople } from './media';
import { address, finished, somebody } from './own_service';
import { openViewer } from './viewer_page';

export const CLIPS = [
  ...['pictured', 'step_out', 'walk', 'walk_in_place'],
  ...['idle', 'run_in_place', 'jump', 'sit', 'wave', 'dance', 'bow'],
];

/** Somebody in a deep bend of the knees: all the body is lower, and the feet are where they were. */
const CROUCHING = Object.fromEntries(
  ['Left', 'Right'].flatMap((side) => [
    [`${side}UpLeg`, [-70, 0, 0]],
    [`${side}Leg`, [110, 0, 0]],
    [`${side}Foot`, [-30, 0, 0]],
  ]),
);
/** What is ordered beside the finished character that all files have; each in the one file that asks for it. */
const ORDERS = {
  two: { several: true, options: { person_index: 'all' } },
  crouching: { several: false, options: { pose: CROUCHING } },
};

/** Orders a character; its job's id. One of the same person begins with what the finished one has found out about them. */
async function ordered({ several, options }: (typeof ORDERS)[keyof typeof ORDERS]): Promise<string> {
  if (!several) return revise(address, finished.character, options);
  const folder = mkdtempSync(join(tmpdir(), 'galatea-viewer-'));
  const people = join(folder, 'people.png');
  try {
    await samplePeople(people, 400);
    return await orderCharacter(address, people, { ...LIGHT, ...options });
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** What a file of tests has: called once in it, it sets up a browser and a character. */
export function aViewer(of: 'one' | keyof typeof ORDERS = 'one') {
  let browser: Browser;
  let job = finished.character;
  /** Graphics without a card cost by the pixel: of one person a quarter of them shows enough. */
  const seen = of === 'one' ? { viewport: { width: 760, height: 800 }, deviceScaleFactor: 0.5 } : { viewport: { width: 760, height: 1000 } };

  beforeAll(async () => {
    if (of !== 'one') job = await ordered(ORDERS[of]);
    browser = await launch(['--enable-unsafe-swiftshader']);
    await ended(address, job);
  }, LONG);
  afterAll(() => browser?.close());
  afterEach(async () => {
    for (const context of browser.contexts()) await context.close();
    expect(complaints.splice(0)).toEqual([]);
  });

  const open = async (options: Parameters<Browser['newPage']>[0] = {}, by = browser): Promise<Page> => {
    const page = await by.newPage({ ...seen, reducedMotion: 'reduce', ...options });
    watch(page);
    await page.addInitScript(countDrawings);
    await openViewer(page, job);
    return page;
  };
  return { open, countDrawings, job: () => job, picture: () => readFileSync(somebody) };
}

declare global {
  interface Window {
    /** How often the graphics were asked to draw. */
    drawn: number;
  }
}

/** In the page: counts how often the graphics are asked to draw. */
function countDrawings(): void {
  const kind = WebGL2RenderingContext?.prototype;
  window.drawn = 0;
  for (const name of kind ? (['drawElements', 'drawArrays'] as const) : []) {
    const draw = kind[name] as (...given: unknown[]) => void;
    Object.assign(kind, {
      [name](this: unknown, ...given: unknown[]) {
        window.drawn++;
        return draw.apply(this, given);
      },
    });
  }
}

/** Until the character stands there and nothing is drawn any more. */
export async function ready(page: Page): Promise<void> {
  await page.locator('.viewer-stage[aria-busy="false"]').waitFor();
  await still(page);
}

export const drawings = (page: Page): Promise<number> => page.evaluate(() => window.drawn);

/** In the page: until it had so many turns, in each of which it may draw and then act on what is seen. */
export const turns = (page: Page, count: number): Promise<void> =>
  page.evaluate(async (count) => {
    for (let turn = 0; turn < count; turn++) {
      await new Promise<void>((done) => requestAnimationFrame(() => setTimeout(done)));
    }
  }, count);

/**
 * Until what was asked for is drawn, and nothing more is. What follows from a click takes turns of the page: its state, what
 * it does once that is seen, a frame of the graphics. So it is turns that are waited for, however long they take.
 */
export async function still(page: Page): Promise<void> {
  for (let before = -1, now = await drawings(page); before !== now; ) {
    await turns(page, 6);
    [before, now] = [now, await drawings(page)];
  }
}

export const shot = (page: Page): Promise<Buffer> => page.locator('.viewer-stage').screenshot();
export const mode = (page: Page, name: string) => page.getByRole('button', { name, exact: true });

/** How much of the stage differs from how it was, in pixels of its layout; by the browser's own decoder. */
export const differing = async (page: Page, before: Buffer): Promise<number> =>
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
      return count / devicePixelRatio ** 2;
    },
    [before, await shot(page)].map((picture) => picture.toString('base64')),
  );

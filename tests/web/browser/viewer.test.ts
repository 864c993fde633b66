/** A character made by the real service, in the page's viewer and in model-viewer, in a real Chromium without a GPU. */

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { AxeResults } from 'axe-core';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, inject, it } from 'vitest';
import { ask, inPython, launch, LONG } from './page';
import { buildViewerPage, type Files, openViewer } from './viewer_page';

const picture = join(tmpdir(), 'galatea-somebody.png');
const CLIPS = ['pictured', 'step_out', 'walk', 'walk_in_place', 'idle'];

let browser: Browser;
let files: Files;
let job: string;
const complaints: string[] = [];

beforeAll(async () => {
  inPython(
    'import sys; from engine.character.sample import sample_picture; from PIL import Image; Image.fromarray(sample_picture()).save(sys.argv[1])',
    picture,
  );
  const body = new FormData();
  body.append('kind', 'character');
  body.append('photo', new Blob([readFileSync(picture)]), 'somebody.png');
  body.append('options', JSON.stringify({ seconds: 2, size: [240, 320] }));
  const ordered = await fetch(`${inject('address')}/v1/jobs`, { method: 'POST', body });
  job = ((await ordered.json()) as { id: string }).id;
  [browser, files] = await Promise.all([launch(['--enable-unsafe-swiftshader']), buildViewerPage()]);
  const deadline = Date.now() + LONG;
  for (let status = ''; status !== 'succeeded'; await new Promise((wake) => setTimeout(wake, 500))) {
    const told = await ask<{ status: string; error: object | null }>(`/v1/jobs/${job}`);
    status = told.status;
    if (status === 'failed' || Date.now() > deadline) throw new Error(`the character is ${status}: ${JSON.stringify(told.error)}`);
  }
}, LONG);
afterAll(() => browser?.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints).toEqual([]);
});

async function open(options: Parameters<Browser['newPage']>[0] = {}, by = browser): Promise<Page> {
  const page = await by.newPage({ viewport: { width: 760, height: 1000 }, reducedMotion: 'reduce', ...options });
  complaints.length = 0;
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  await page.addInitScript(() => {
    // how often the graphics are asked to draw
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
  });
  await openViewer(page, files, job);
  return page;
}

/** Until the character stands there and nothing is drawn any more. */
async function ready(page: Page): Promise<void> {
  await page.locator('.viewer-stage[aria-busy="false"]').waitFor({ timeout: 60_000 });
  await still(page);
}

const drawings = (page: Page): Promise<number> => page.evaluate(() => (window as unknown as { drawn: number }).drawn);

async function still(page: Page): Promise<void> {
  for (let before = -1, now = 0; before !== now; ) {
    [before, now] = [now, await drawings(page)];
    await page.waitForTimeout(250);
  }
}

const shot = (page: Page): Promise<Buffer> => page.locator('.viewer-stage').screenshot();
const mode = (page: Page, name: string) => page.getByRole('button', { name, exact: true });

/** How many pixels differ between two pictures of one size; by the browser's own decoder. */
const differing = (page: Page, first: Buffer, second: Buffer): Promise<number> =>
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

describe('a character in three', () => {
  it('has every clip, and each moves the mesh with its joints', async () => {
    const page = await open();
    await ready(page);
    const { clips } = await page.evaluate(() => window.measure());
    expect(Object.keys(clips)).toEqual(CLIPS);
    expect(clips.pictured).toMatchObject({ vertex: 0, joint: 0, loops: false });
    for (const [name, least] of [['step_out', 0.3], ['walk', 0.3], ['walk_in_place', 0.2], ['idle', 0.001]] as const) {
      expect(clips[name]!.joint, `joints of ${name}`).toBeGreaterThan(least);
      expect(clips[name]!.vertex, `mesh of ${name}`).toBeGreaterThan(least);
    }
    expect(clips.walk!.loops && clips.walk_in_place!.loops && clips.idle!.loops).toBe(true);
    expect(clips.step_out!.loops).toBe(false);
  });
});

describe('looking around', () => {
  it('shows a clip at any of its moments, plays it, and draws only what has changed', async () => {
    const page = await open();
    await ready(page);
    const drawn = await drawings(page);
    await page.waitForTimeout(600);
    expect(await drawings(page), 'at rest nothing is drawn').toBe(drawn);

    const begin = await shot(page);
    const position = page.getByRole('slider', { name: 'Position' });
    await position.fill('0.5');
    await still(page);
    const later = await shot(page);
    expect(await differing(page, begin, later)).toBeGreaterThan(300);
    await position.fill('0');
    await still(page);
    expect(await differing(page, begin, await shot(page)), 'going back is coming back').toBe(0);

    await page.getByRole('combobox', { name: 'Clip' }).selectOption('step_out');
    const tall = () => page.evaluate(() => window.joint('LeftFoot')[1] - window.joint('Head')[1]);
    await still(page);
    const before = await tall();
    await page.getByRole('button', { name: 'Play' }).click();
    await page.getByRole('button', { name: 'Play' }).waitFor({ timeout: 60_000 }); // it ends by itself
    expect(await tall(), 'the person has come nearer').toBeGreaterThan(1.1 * before);
    expect(Number(await position.inputValue())).toBeGreaterThan(1.5);
  });

  it('is circled around by mouse and keys, and comes back', async () => {
    const page = await open();
    await ready(page);
    const front = await shot(page);
    const { x, y, width, height } = (await page.locator('.viewer-stage').boundingBox())!;
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 180, y + height / 2, { steps: 4 });
    await page.mouse.up();
    await still(page);
    expect(await differing(page, front, await shot(page))).toBeGreaterThan(1000);
    await page.getByRole('button', { name: 'View from the front' }).click();
    await still(page);
    expect(await differing(page, front, await shot(page))).toBe(0);
    await page.locator('.viewer-stage').focus();
    await page.keyboard.press('ArrowLeft');
    await still(page);
    const turned = await page.evaluate(() => window.joint('LeftHand'));
    await page.keyboard.press('ArrowRight');
    await still(page);
    const back = await page.evaluate(() => window.joint('LeftHand'));
    expect(Math.abs(turned[0] - back[0])).toBeGreaterThan(3);
    for (const key of ['ArrowUp', '+', '+', '-', 'ArrowDown', '-']) await page.keyboard.press(key);
    await page.locator('.viewer-stage').blur();
    await still(page);
    expect(await differing(page, front, await shot(page)), 'each key undoes another').toBeLessThan(20);
  });

  it('shows the skeleton over the mesh, and another background', async () => {
    const page = await open();
    await ready(page);
    const bare = await shot(page);
    await page.getByRole('button', { name: 'Skeleton' }).click();
    await still(page);
    expect(await differing(page, bare, await shot(page))).toBeGreaterThan(150);
    await page.getByRole('button', { name: 'Skeleton' }).click();
    await still(page);
    expect(await differing(page, bare, await shot(page))).toBe(0);
    await page.getByRole('button', { name: 'Dark background' }).click();
    await still(page);
    const all = (await page.locator('.viewer-stage').boundingBox())!;
    expect(await differing(page, bare, await shot(page))).toBeGreaterThan(0.6 * all.width * all.height);
  });

  it('gives the graphics back when it goes', async () => {
    const page = await open();
    await ready(page);
    const lost = await page.evaluate(async () => {
      const context = document.querySelector('canvas')!.getContext('webgl2')!;
      window.leave();
      await new Promise((wake) => setTimeout(wake, 200));
      return [context.isContextLost(), document.querySelector('canvas')];
    });
    expect(lost).toEqual([true, null]);
  });

  it('says so where there is no WebGL', async () => {
    const without = await launch(['--disable-3d-apis']);
    try {
      const page = await open({}, without);
      await page.getByText('This browser shows no 3D').waitFor();
      expect(await page.getByRole('button', { name: 'View in your space' }).count()).toBe(1);
    } finally {
      await without.close();
    }
  });

  it.each(['light', 'dark'] as const)('is for everybody: no barriers that axe knows, %s', async (colorScheme) => {
    const page = await open({ colorScheme });
    await ready(page);
    const axe = createRequire(new URL('../../../web/package.json', import.meta.url)).resolve('axe-core/axe.min.js');
    await page.evaluate(readFileSync(axe, 'utf8'));
    for (const name of ['Look around', 'Change the pose']) {
      await mode(page, name).click();
      await still(page);
      const { violations } = await page.evaluate(
        () => (window as unknown as { axe: { run: (where: string) => Promise<AxeResults> } }).axe.run('.viewer'),
      );
      expect(violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)])).toEqual([]);
    }
  });
});

describe('a pose by hand', () => {
  it('brings the wrist under the pointer, and is told as degrees from the pictured pose', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'Change the pose').click();
    await still(page);
    const make = page.getByRole('button', { name: 'Make it so' });
    expect(await make.isDisabled()).toBe(true);
    const [x, y] = await page.evaluate(() => window.joint('LeftHand'));
    const [toX, toY] = [x + 12, y - 70];
    const canvas = (await page.locator('canvas').boundingBox())!;
    const pointer = (right: number, down: number) => page.mouse.move(canvas.x + right, canvas.y + down);
    await pointer(x + 2, y + 1);
    await page.mouse.down();
    await pointer(toX + 30, toY + 8);
    await pointer(toX + 2, toY + 1);
    await page.mouse.up();
    await still(page);
    const [wristX, wristY] = await page.evaluate(() => window.joint('LeftHand'));
    expect(Math.hypot(wristX - toX, wristY - toY), 'pixels from the pointer').toBeLessThan(1);

    await make.click();
    const poses = await page.evaluate(() => window.poses);
    expect(poses).toHaveLength(1);
    const pose = poses[0]!;
    expect(Object.keys(pose).sort()).toEqual(['LeftArm', 'LeftForeArm']);
    const shown = await page.evaluate(() => window.rotations(['LeftArm', 'LeftForeArm']));
    for (const [index, name] of (['LeftArm', 'LeftForeArm'] as const).entries()) {
      const told = await page.evaluate(([name, degrees]) => window.turned(name, degrees), [name, pose[name]!] as const);
      const cosine = Math.abs(told.reduce((sum, part, axis) => sum + part * shown[index]![axis]!, 0));
      expect(Math.acos(Math.min(1, cosine)) * (360 / Math.PI), `degrees that ${name} is off`).toBeLessThan(0.05);
    }

    await page.getByRole('button', { name: 'Undo' }).click();
    await still(page);
    const [backX, backY] = await page.evaluate(() => window.joint('LeftHand'));
    expect(Math.hypot(backX - x, backY - y)).toBeLessThan(0.01);
    expect(await make.isDisabled()).toBe(true);
    await page.getByRole('button', { name: 'Redo' }).click();
    await still(page);
    expect(await page.evaluate(() => window.joint('LeftHand'))).toEqual([wristX, wristY]);
  });

  it('is made with the keyboard, too', async () => {
    const page = await open();
    await ready(page);
    await mode(page, 'Change the pose').click();
    await page.getByRole('combobox', { name: 'Bone' }).selectOption('Head');
    await page.getByRole('slider', { name: 'Twist' }).focus();
    for (let press = 0; press < 3; press++) await page.keyboard.press('ArrowRight');
    await page.getByRole('button', { name: 'Make it so' }).click();
    expect(await page.evaluate(() => window.poses)).toEqual([{ Head: [0, 3, 0] }]);
    await page.locator('.viewer-stage').focus();
    await page.keyboard.press('Control+z');
    await page.getByRole('button', { name: 'Make it so' }).click();
    expect(await page.evaluate(() => window.poses[1])).toEqual({ Head: [0, 2, 0] });
    await page.getByRole('button', { name: 'As pictured' }).click();
    expect(await page.getByRole('button', { name: 'Make it so' }).isDisabled()).toBe(true);
  });

  it('turns the mesh half transparent while it is edited, and solid again', async () => {
    const page = await open();
    await ready(page);
    const solid = await shot(page);
    await mode(page, 'Change the pose').click();
    await still(page);
    await mode(page, 'Look around').click();
    await still(page);
    expect(await differing(page, solid, await shot(page))).toBe(0);
  });
});

describe('the picture on the wall', () => {
  it('is the picture that was sent, until the person steps out and leaves it empty', async (context) => {
    const page = await open();
    await ready(page);
    if ((await page.evaluate(() => window.picture())) === null) context.skip('the job does not say where its camera stood');
    await mode(page, 'On the wall').click();
    await still(page);
    const place = (await page.evaluate(() => window.picture()))!;
    const [left, top, right, bottom] = place;
    const canvas = (await page.locator('canvas').boundingBox())!;
    const clip = { x: canvas.x + left, y: canvas.y + top, width: right - left, height: bottom - top };
    /** Mean difference from a picture, in shares of the brightest, where both are as large as the smaller. */
    const from = async (url: string): Promise<number> => {
      const seen = (await page.screenshot({ clip })).toString('base64');
      return page.evaluate(
        async ([seen, url]) => {
          const blobs = await Promise.all([fetch(`data:image/png;base64,${seen}`), fetch(url)].map(async (got) => (await got).blob()));
          const [one, other] = (await Promise.all(
            blobs.map(async (blob) => {
              const pen = new OffscreenCanvas(90, 120).getContext('2d')!;
              pen.drawImage(await createImageBitmap(blob), 0, 0, 90, 120);
              return pen.getImageData(0, 0, 90, 120).data;
            }),
          )) as [Uint8ClampedArray, Uint8ClampedArray];
          return one.reduce((sum, value, index) => sum + Math.abs(value - other[index]!), 0) / one.length / 255;
        },
        [seen, url] as const,
      );
    };
    const sent = `data:image/png;base64,${readFileSync(picture).toString('base64')}`;
    const { artifacts } = await ask<{ artifacts: Record<string, { url: string }> }>(`/v1/jobs/${job}`);
    const empty = artifacts['background.png']!.url;
    const atFirst = await from(sent);
    expect(atFirst, 'in the picture, as it was').toBeLessThan(0.02);
    expect(atFirst).toBeLessThan((await from(empty)) / 2);

    // from aside, too: it is paint
    await page.locator('.viewer-stage').focus();
    for (let press = 0; press < 3; press++) await page.keyboard.press('ArrowRight');
    await page.locator('.viewer-stage').blur();
    await still(page);
    const aside = await shot(page);
    await page.getByRole('button', { name: 'Play' }).click();
    await page.waitForTimeout(6000);
    await page.getByRole('button', { name: 'Pause' }).click();
    await still(page);
    expect(await differing(page, aside, await shot(page))).toBeGreaterThan(2000);
    await page.getByRole('button', { name: 'Back into the picture' }).click();
    await still(page);
    expect(await differing(page, aside, await shot(page)), 'as before').toBe(0);
    expect(await page.getByRole('button', { name: 'Enter with a headset' }).count(), 'no headset, no button').toBe(0);
  });
});

describe('model-viewer', () => {
  it('shows the same character with the same clips, and plays them', async () => {
    const page = await open({ reducedMotion: 'no-preference' });
    const asked: string[] = [];
    page.on('request', (request) => asked.push(request.url()));
    await page.locator('.viewer-stage[aria-busy="false"]').waitFor({ timeout: 60_000 });
    await page.getByRole('button', { name: 'View in your space' }).click();
    await page.waitForFunction(() => document.querySelector('model-viewer')?.loaded, undefined, { timeout: 90_000 });
    const shown = await page.evaluate(() => {
      const viewer = document.querySelector('model-viewer')!;
      return {
        clips: viewer.availableAnimations,
        modes: viewer.getAttribute('ar-modes'),
        files: [viewer.src, viewer.iosSrc],
      };
    });
    expect(shown.clips).toEqual(CLIPS);
    expect(shown.modes).toBe('webxr scene-viewer quick-look');
    for (const [file, name] of [[shown.files[0], 'character.glb'], [shown.files[1], 'character.usdz']] as const) {
      expect(file, 'an address for apps outside the browser').toMatch(/^http:\/\/127\.0\.0\.1/);
      expect(new URL(file ?? '').pathname.endsWith(`/${name}`)).toBe(true);
      expect((await fetch(file ?? '')).status, 'it opens without a cookie').toBe(200);
    }
    await page.getByText('This device has no AR').waitFor();
    await page.waitForFunction(
      () => {
        const viewer = document.querySelector('model-viewer')!;
        return !viewer.paused && viewer.animationName === 'walk_in_place' && viewer.currentTime > 0.1;
      },
      undefined,
      { timeout: 60_000 },
    );
    const ours = new RegExp(`^(${inject('address')}/|blob:|data:)`);
    expect(asked.filter((url) => !ours.test(url)), 'nobody else is asked for anything').toEqual([]);
    await page.getByRole('button', { name: 'Close' }).click();
    expect(await page.locator('model-viewer').count()).toBe(0);
  });
});

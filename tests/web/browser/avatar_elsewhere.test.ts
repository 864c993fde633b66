/** An avatar in the programs of others that avatars are made for, each as it comes from npm. */

import { mkdtempSync, rmSync } from 'node:fs';
import type { Server } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it, vi } from 'vitest';
import { launch, PATIENCE } from './browser';
import { complaints, watch } from './complaints';
import { buildPages, serveFolder } from './elsewhere/building';
import type { CompressedPage, TalkingHeadPage, VrmPage } from './elsewhere/pages';
import { inPython } from './media';

const AVATAR = `
import sys
from pathlib import Path
sys.path.insert(0, "tests/live_service")
from engine.avatar.options import AvatarOptions
from template_avatar import write_template_avatar
from engine.export.gltf.meshopt_compression import compressed
folder = Path(sys.argv[1])
write_template_avatar(folder, AvatarOptions(vrm=True))
(folder / "small.glb").write_bytes(compressed((folder / "avatar.glb").read_bytes()))
`;

const folder = mkdtempSync(join(tmpdir(), 'galatea-elsewhere-'));
let browser: Browser;
let server: Server;
let address: string;
const elsewhere: string[] = [];
beforeAll(async () => {
  inPython(AVATAR, folder);
  await buildPages(folder, ['talking_head', 'vrm', 'model_viewer', 'compressed']);
  ({ server, address } = await serveFolder(folder));
  browser = await launch(['--enable-unsafe-swiftshader', '--autoplay-policy=no-user-gesture-required']);
});
afterAll(async () => {
  await browser?.close();
  server?.close();
  rmSync(folder, { recursive: true, force: true });
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
  expect(elsewhere.splice(0), 'asked of other machines').toEqual([]);
});

async function open(name: string): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 160, height: 220 } });
  watch(page);
  page.on('request', (request) => /^(blob|data):/.test(request.url()) || request.url().startsWith(address) || elsewhere.push(request.url()));
  await page.goto(`${address}/${name}.html`);
  await page.waitForFunction(() => 'page' in window);
  return page;
}

/** The functions of a page, to be called from here. */
function calls<Of>(page: Page) {
  return <Name extends keyof Of & string>(
    name: Name,
    ...given: Of[Name] extends (...given: infer Given) => unknown ? Given : never
  ): Promise<Of[Name] extends (...given: never[]) => infer Answer ? Answer : never> =>
    page.evaluate(([name, given]) => (window as never as { page: Record<string, (...given: unknown[]) => never> }).page[name]!(...given), [
      name,
      given,
    ] as [string, unknown[]]);
}

describe('in TalkingHead', () => {
  it('stands as its poses mean it, whose angles are those of Ready Player Me’s joints', async () => {
    const call = calls<TalkingHeadPage>(await open('talking_head'));
    const at = (...names: string[]) => call('joints', ...names) as Promise<[number, number, number][]>;
    const sides = ['Left', 'Right'] as const;
    // relaxed: hands beside the hips, palms' length before and behind them, feet below
    // it goes over into its pose by and by, and breathes then: what is held is of one moment
    await vi.waitFor(async () => {
      const [arm, hips, head, left, right, ...legs] = await at(
        ...['LeftArm', 'Hips', 'Head', 'LeftHand', 'RightHand'],
        ...sides.flatMap((side) => [`${side}Leg`, `${side}Foot`, `${side}ToeBase`]),
      );
      expect(arm![1] - left![1]).toBeGreaterThan(0.35);
      expect(left![0] - hips![0]).toBeGreaterThan(0.1);
      expect(right![0] - hips![0]).toBeLessThan(-0.1);
      for (const hand of [left!, right!]) expect(Math.hypot(hand[0] - hips![0], hand[2] - hips![2])).toBeLessThan(0.45);
      expect(head![1] - hips![1], 'upright').toBeGreaterThan(0.5);
      for (const [knee, foot, toes] of [legs.slice(0, 3), legs.slice(3)]) {
        expect(hips![1] - knee![1]).toBeGreaterThan(0.35);
        expect(knee![1] - foot![1]).toBeGreaterThan(0.3);
        expect(toes![2] - foot![2], 'feet point forward').toBeGreaterThan(0.03);
        expect(toes![1]).toBeLessThan(foot![1]);
      }
    }, PATIENCE);
  });

  it('has every target that it looks for, and speaks by audio and visemes alone', async () => {
    const call = calls<TalkingHeadPage>(await open('talking_head'));
    const targets = await call('targets');
    expect(targets).toEqual(expect.arrayContaining(['mouthOpen', 'mouthSmile', 'eyesClosed', 'eyesLookUp', 'eyesLookDown']));
    expect(targets.filter((name) => name.startsWith('viseme_'))).toHaveLength(15);
    expect(targets, 'none had to be made').toHaveLength(72);
    expect(await call('influence', 'viseme_aa')).toBe(0);
    await call('speak', ['PP', 'aa', 'aa'], 6000); // long enough to be seen by a machine that draws a frame in two seconds
    const { pixels, above } = await call('shaped', 'viseme_aa', 0.3);
    expect(pixels, 'of the mouth').toBeGreaterThan(25);
    expect(above, 'an edge of the hair, at most').toBeLessThan(pixels / 20);
  });
});

describe('in three-vrm', () => {
  it('has expressions that move what they name, and nothing else', async () => {
    const call = calls<VrmPage>(await open('vrm'));
    const [eyes, head] = [await call('joint', 'leftEye'), await call('joint', 'head')];
    const expressions = await call('expressions');
    for (const name of ['happy', 'angry', 'sad', 'relaxed', 'surprised', 'aa', 'ih', 'ou', 'ee', 'oh']) {
      expect(expressions).toContain(name);
      const { most, heights } = await call('express', name);
      expect(most, name).toBeGreaterThan(2e-3);
      expect(heights[0], `${name}: from the chin`).toBeGreaterThan(head[1] - 0.08);
    }
    for (const name of ['aa', 'oh']) expect((await call('express', name)).heights[1], 'below the eyes').toBeLessThan(eyes[1]);
    const blink = await call('express', 'blink');
    expect(blink.most).toBeGreaterThan(5e-3);
    for (const height of blink.heights) expect(Math.abs(height - eyes[1]), 'of the lids').toBeLessThan(0.05);
  });

  it('looks at what it is told to look at, as far as eyes turn', async () => {
    const call = calls<VrmPage>(await open('vrm'));
    for (const [left, up] of [[20, 0], [-20, 0], [0, 15]] as const) {
      const [turned, raised] = await call('lookAside', left, up);
      expect(turned).toBeCloseTo(left, -0.5);
      expect(raised).toBeCloseTo(up, -0.5);
    }
    expect((await call('lookAside', 80, 0))[0]).toBeCloseTo(30, -0.5);
  });

  it('is posed by the bones of VRM', async () => {
    const call = calls<VrmPage>(await open('vrm'));
    const shoulder = await call('joint', 'leftUpperArm');
    await call('turn', 'leftUpperArm', 'z', -90);
    const hand = await call('joint', 'leftHand');
    expect(Math.abs(hand[0] - shoulder[0]), 'hangs down').toBeLessThan(0.02);
    expect(shoulder[1] - hand[1]).toBeGreaterThan(0.4);
  });
});

describe('in model-viewer', () => {
  it('is shown, and plays its clips', async () => {
    const page = await open('model_viewer');
    const seen = () =>
      page.evaluate(() => {
        const viewer = document.querySelector('model-viewer')!;
        return { loaded: viewer.loaded, names: viewer.availableAnimations, duration: viewer.duration, at: viewer.currentTime };
      });
    const { loaded, names, duration } = await seen();
    expect(loaded).toBe(true);
    expect(names).toEqual(['wave', 'filmed', 'idle', 'walk', 'run', 'jump', 'sit', 'dance', 'bow']);
    expect(duration).toBeGreaterThan(1);
    await expect.poll(async () => (await seen()).at).toBeGreaterThan(0);
  });
});

describe('compressed, in three.js', () => {
  it('is the same avatar: its shape, its expressions, its motion', async () => {
    const call = calls<CompressedPage>(await open('compressed'));
    const { triangles, targets, rest, opened, waving } = await call('compare', 'jawOpen', 'wave');
    expect(triangles).toBe(27_676);
    expect(targets).toHaveLength(72);
    for (const apart of [rest, opened, waving]) expect(apart, 'metres').toBeLessThan(1e-3);
  });
});

import './characters_only';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints, expectComplaint, unanswered } from './complaints';
import { accepted, again, isMade, isOrder, launchIn3D, openCorrections, openStill, revised } from './character_kit';
import { LIGHT, LONG } from './jobs';
import { lacks } from './lacks';
import { inPython, inPythonBeside, samplePeople } from './media';
import { onScreen } from './on_screen';
import { address, finished, somebody } from './own_service';
import { ask, cancelAll, jobOf, open, orderCharacter } from './page';

interface Made {
  inputs: Record<string, string>;
  options: Record<string, unknown>;
  revision_of: string | null;
}
type Joints = Record<string, { place: [number, number] }>;

/** What the engine lets be placed, what it needs where nobody is found, and the colours of its labels. */
const NAMES = `
import json
from engine.character.figure.placed_joints import PLACEABLE_JOINTS, REQUIRED_PLACED_JOINTS
from engine.character.figure.strokes import LABEL_COLOURS
print(json.dumps([PLACEABLE_JOINTS, REQUIRED_PLACED_JOINTS, LABEL_COLOURS.tolist()]))
`;

/** A motion of the tests' own. */
const MOTION = `
import sys
sys.path.insert(0, "tests/live_service")
from made_motion import bvh
open(sys.argv[1], "wb").write(bvh())
`;

const folder = mkdtempSync(join(tmpdir(), 'galatea-person-'));
let browser: Browser;
const done = finished.character;
let engine: [joints: string[], needed: string[], colours: number[][]];
beforeAll(async () => {
  browser = await launchIn3D();
  await samplePeople(join(folder, 'two.png'), 400);
  engine = JSON.parse(inPython(NAMES)) as typeof engine;
});
afterAll(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  await cancelAll();
  expect(complaints.splice(0)).toEqual([]);
});

const start = (page: Page) => page.getByRole('button', { name: 'Create character' });
const stage = (page: Page) => page.getByRole('dialog').getByRole('application');
const use = (page: Page) => page.getByRole('button', { name: 'Apply' });
const skeleton = async (id: string): Promise<Joints> =>
  (await ask<{ joints: Joints }>(`/v1/jobs/${id}/artifacts/skeleton.json`)).joints;

async function cancel(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Cancel' }).click();
  await page.getByText('This job was canceled before it was done').waitFor();
}

/** The page of the finished character, with its corrections open. */
async function corrections(id = done, options: Parameters<typeof open>[2] = {}): Promise<Page> {
  const page = await openStill(browser, `#/jobs/${id}`, options);
  await openCorrections(page);
  return page;
}

/** What a click on “Make it again” sends. */
const revision = async (page: Page): Promise<{ corrections: Record<string, any>; options: Record<string, any> }> =>
  (await revised(page)).postDataJSON();

async function drag(page: Page, ...places: [number, number][]): Promise<void> {
  const [first, ...rest] = await onScreen(page, places);
  await page.mouse.move(...first!);
  await page.mouse.down();
  for (const place of rest) await page.mouse.move(...place, { steps: 4 });
  await page.mouse.up();
}

describe('ordering a character', () => {
  it('is one of two things to make, each with an address', async () => {
    const page = await openStill(browser);
    const making = page.getByRole('navigation', { name: 'What to make' });
    await making.getByRole('link', { name: 'Character' }).click();
    await page.getByRole('heading', { name: 'Let a person walk out of their picture' }).waitFor();
    await page.waitForURL((url) => url.hash === '#/character');
    await expect.poll(() => page.getByRole('radio').count()).toBe(8);
    await expect.poll(() => start(page).isDisabled()).toBe(true);
    await making.getByRole('link', { name: 'Portrait' }).click();
    await page.getByRole('heading', { name: 'Bring a portrait to life' }).waitFor();
  });

  it('sends the picture, the motion and what was chosen', async () => {
    const page = await openStill(browser, '#/character');
    await page.getByLabel(/Drop a picture/).setInputFiles(somebody);
    await page.getByText('Dance', { exact: true }).click();
    await page.getByText('Options').click();
    await page.getByLabel('Head').check();
    await page.getByLabel('Camera').selectOption('Orbit');
    await page.getByLabel('Length of the video').fill('2');
    await page.getByLabel('Also a lit preview image').check();
    const [request] = await Promise.all([page.waitForRequest(isOrder), start(page).click()]);
    const sent = request.postDataJSON();
    expect(sent).toEqual({
      kind: 'character',
      inputs: { photo: expect.stringMatching(/^[0-9a-f-]{36}$/), motion: 'dance' },
      options: { keep: ['head'], camera: 'orbit', seconds: 2, lit: true },
      metadata: { photo: 'Somebody' },
    });
    expect(request.headers()['idempotency-key']).toMatch(/./);
    await page.getByRole('heading', { name: 'Somebody' }).waitFor();
    await page.getByText('Motion: Dance', { exact: true }).waitFor();
    await cancel(page);
  });

  it('makes the video and the character as chosen, and with what is changed of them next', async () => {
    const page = await openStill(browser, '#/character');
    await page.getByLabel(/Drop a picture/).setInputFiles(somebody);
    await page.getByText('Options').click();
    await page.getByLabel('Length of the video').fill('1');
    const choices = [
      ...[['Size', 'Up to 512 × 512 pixels'], ['Frames per second', '24'], ['File format', 'WebM']],
      ...[['Maximum triangles', '10,000'], ['Levels of detail (LOD)', '1']],
    ] as const;
    for (const [label, choice] of choices) await page.getByLabel(label).selectOption({ label: choice });
    const [request] = await Promise.all([page.waitForRequest(isOrder), start(page).click()]);
    expect(request.postDataJSON().options).toEqual({
      ...{ seconds: 1, size: [512, 512], fps: 24, format: 'webm', triangles: 10_000, levels: 1 },
    });
    await page.waitForURL((url) => url.hash.startsWith('#/jobs/'));
    await openCorrections(page);
    const { artifacts } = await ask<{ artifacts: Record<string, unknown> }>(`/v1/jobs/${jobOf(page)}`);
    expect(Object.keys(artifacts)).toEqual(expect.arrayContaining(['animation.webm', 'character-lod1.glb']));
    await page.getByRole('button', { name: 'Video', exact: true }).click();
    const video = page.locator('video');
    await expect.poll(() => video.evaluate((film: HTMLVideoElement) => Math.max(film.videoWidth, film.videoHeight))).toBe(512);

    for (const [label, choice] of choices) {
      await expect.poll(() => page.getByLabel(label).locator('option:checked').textContent()).toBe(choice);
    }
    await page.getByLabel('Frames per second').selectOption('50');
    await page.getByLabel('File format').selectOption('MP4');
    await page.getByLabel('Levels of detail (LOD)').selectOption('None');
    const again = await revised(page);
    expect(again.postDataJSON()).toEqual({ corrections: {}, options: { fps: 50, format: null, levels: null } });
    await accepted(again);
  });

  it('offers the motions that the service keeps', async () => {
    const file = join(folder, 'swing.bvh');
    await inPythonBeside(MOTION, file);
    const form = new FormData();
    form.set('name', 'arm-swing');
    form.set('file', new Blob([readFileSync(file)]), 'swing.bvh');
    expect((await fetch(`${address}/v1/motions`, { method: 'POST', body: form })).status).toBe(201);
    const checked = async (): Promise<string> =>
      (await ask<{ check_status: string }>('/v1/motions/arm-swing')).check_status;
    await expect.poll(checked, { timeout: LONG }).toBe('ready');
    const page = await openStill(browser, '#/character');
    await page.getByLabel(/Drop a picture/).setInputFiles(somebody);
    await page.locator('.cards').getByText('Arm swing', { exact: true }).click();
    const [request] = await Promise.all([page.waitForRequest(isOrder), start(page).click()]);
    const sent = request.postDataJSON();
    expect([sent.inputs.motion, sent.metadata.motion]).toEqual(['arm-swing', 'Arm swing']);
    await page.getByText('Motion: Arm swing', { exact: true }).waitFor();
    await cancel(page);
  });

  it('refuses what is no motion, and finds the place of one that is dropped anywhere', async () => {
    const page = await openStill(browser, '#/character');
    await page.getByLabel(/Drop a BVH/).setInputFiles({ name: 'a.fbx', mimeType: '', buffer: Buffer.from('x') });
    await page.getByRole('alert').filter({ hasText: 'This is not a motion file.' }).waitFor();
    await page.evaluate(() => {
      const data = new DataTransfer();
      data.items.add(new File(['HIERARCHY\n'], 'cartwheel.bvh'));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    });
    await lacks(page.locator('input[type=radio]:checked'), page.getByLabel('Motion: cartwheel.bvh. Choose another'));
  });

  it('goes on after the page was loaded anew, on the page of portraits too', async () => {
    const motion = join(folder, 'long walk.bvh');
    writeFileSync(motion, `HIERARCHY\nROOT Hips\n{\n${'  OFFSET 0 0 0\n'.repeat(80_000)}`);
    const page = await openStill(browser, '#/character');
    const line = await page.context().newCDPSession(page);
    const slow = (uploadThroughput: number) =>
      line.send('Network.emulateNetworkConditions', { offline: false, latency: 0, downloadThroughput: -1, uploadThroughput });
    await slow(150_000);
    await page.getByLabel(/Drop a picture/).setInputFiles(somebody);
    await page.getByLabel(/Drop a BVH/).setInputFiles(motion);
    await start(page).click();
    await page.getByText(/Uploading the motion: [1-9]\d?%/).waitFor();
    await page.goto(`${address}/#/`);
    await page.reload();
    await page.getByText(/The upload of “Somebody” \(Long walk\) was interrupted/).waitFor();
    await slow(-1);
    await page.getByRole('button', { name: 'Resume upload' }).click();
    await page.getByRole('heading', { name: 'Somebody' }).waitFor();
    await page.getByText('Motion: Long walk', { exact: true }).waitFor();
    const job = await ask<Made>(`/v1/jobs/${jobOf(page)}`);
    expect((await ask<{ content_type: string }>(`/v1/files/${job.inputs.motion}`)).content_type).toBe('text/x-bvh');
    await page.getByRole('alert').waitFor({ timeout: LONG }); // it is no whole motion, and the page says so
  });
});

describe('a finished character', () => {
  it('plays, and can be taken along', async () => {
    const page = await openStill(browser, `#/jobs/${done}`);
    await isMade(page);
    await page.getByRole('button', { name: 'Video', exact: true }).click();
    await page.getByRole('region', { name: 'Result' }).getByRole('button', { name: 'Play' }).click();
    await page.waitForFunction(() => {
      const video = document.querySelector('video');
      return video && video.videoWidth > 0 && (video.currentTime > 0.2 || video.ended);
    });
    for (const [link, file] of [
      ['Download 3D character', 'character.glb'],
      ['USDZ for iPhone', 'character.usdz'],
      ['Video', 'animation.mp4'],
    ] as const) {
      const [download] = await Promise.all([
        page.waitForEvent('download'),
        page.getByRole('link', { name: link }).click(),
      ]);
      expect(download.suggestedFilename()).toBe(file);
    }
    await lacks(page.getByRole('link', { name: 'VRM' }), page.getByRole('link', { name: 'USDZ for iPhone' })); // it was not asked for
    await page.getByText('Share', { exact: true }).click();
    await page.getByRole('button', { name: 'Create link' }).click();
    const link = await page.getByRole('textbox', { name: 'Link' }).inputValue();
    await page.goto(link);
    await page.getByRole('heading', { name: 'A person who walked out of their picture' }).waitFor();
  });

  it('is found among the recent ones and in the history', async () => {
    for (const hash of ['#/character', '#/history']) {
      const page = await openStill(browser, hash);
      const link = page.locator(`a[href="#/jobs/${done}"]`);
      await page.locator('.entry').filter({ has: link }).or(link).locator('img').first().waitFor();
    }
  });

  it.each([320, 390, 1440])('fits a window of %i pixels, start page, result and corrections', async (width) => {
    const page = await openStill(browser, '#/character', { viewport: { width, height: 800 }, deviceScaleFactor: 1 });
    const overflow = () => page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    await page.getByText('Options').click();
    await expect.poll(() => overflow()).toBeLessThanOrEqual(0);
    await page.goto(`${address}/#/jobs/${done}`);
    await page.getByText('Edit and make again').click();
    await page.getByRole('button', { name: 'Paint the mask' }).waitFor();
    await expect.poll(() => overflow()).toBeLessThanOrEqual(0);
  });
});

describe('corrections of a character', () => {
  it('knows the joints that the engine lets be placed, and the colours of its labels', async () => {
    const { limbs, needed } = await import('@web/kinds/character/joints/skeleton');
    const { partColours } = await import('@web/kinds/character/masks/strokes');
    expect([...needed].sort()).toEqual([...engine[1]].sort());
    for (const { from, to } of limbs) expect(engine[0]).toEqual(expect.arrayContaining([from, to]));
    expect(Object.values(partColours)).toEqual(engine[2].slice(0, 6).map((colour) => `rgb(${colour.join(' ')})`));
  });

  it('move a joint by a drag and another by the keyboard, change the motion, and make it again', async () => {
    const page = await corrections();
    await expect.poll(() => again(page).isDisabled()).toBe(true); // nothing is changed yet
    const before = await skeleton(done);
    const [x, y] = before.LeftWrist!.place;
    await page.getByRole('button', { name: 'Move the joints' }).click();
    await stage(page).waitFor();
    await drag(page, [x, y], [x + 8, y - 6]);
    await page.getByRole('status').getByText('Left wrist').waitFor();
    await page.getByRole('button', { name: 'Right knee' }).focus();
    await page.keyboard.press('Tab');
    await page.getByRole('status').getByText('Left ankle').waitFor(); // Tab goes on to the next
    for (const key of ['Shift+ArrowDown', 'ArrowDown', 'Control+z', 'Control+z', 'ArrowRight']) await page.keyboard.press(key);
    await use(page).click();
    await page.getByText('joints are placed by hand.').waitFor();
    await page.locator('.revise').getByLabel('Motion', { exact: true }).selectOption('Bow');
    const sent = await revision(page);
    expect(sent.options).toEqual({ motion: 'bow' });
    expect(Object.keys(sent.corrections)).toEqual(['joints']);
    const { joints } = sent.corrections;
    // a hand comes along with its wrist, a foot with its ankle
    const moved = ['LeftWrist', 'LeftPinky', 'LeftIndex', 'LeftThumb', 'LeftAnkle', 'LeftHeel', 'LeftFootIndex'];
    expect(Object.keys(joints).sort()).toEqual([...moved].sort());
    expect(joints.LeftWrist[0] - x).toBeCloseTo(8, 0);
    expect(joints.LeftWrist[1] - y).toBeCloseTo(-6, 0);
    expect(joints.LeftAnkle[1]).toBeCloseTo(before.LeftAnkle!.place[1], 0); // those steps were undone
    expect(joints.LeftAnkle[0]).toBeGreaterThan(before.LeftAnkle!.place[0] + 0.5);

    await page.waitForURL((url) => url.hash.startsWith('#/jobs/') && !url.hash.endsWith(done));
    await page.getByText('Motion: Bow', { exact: true }).waitFor();
    await isMade(page);
    const job = await ask<Made>(`/v1/jobs/${jobOf(page)}`);
    expect([job.revision_of, job.options.motion, job.options.joints]).toEqual([done, 'bow', joints]);
    const wrist = (await skeleton(jobOf(page))).LeftWrist!.place;
    wrist.forEach((value, axis) => expect(value).toBeCloseTo(joints.LeftWrist[axis], 3));
    await page.getByRole('navigation', { name: 'Versions' }).getByRole('link', { name: '1' }).waitFor();

    // what was placed stays when something else is placed, and can be taken back
    await page.getByText('Edit and make again').click();
    await page.getByText('7 joints are placed by hand.').waitFor();
    await page.getByRole('button', { name: 'Detect again' }).click();
    await page.route('**/revisions', (route) => route.abort());
    expect((await revision(page)).corrections).toEqual({ joints: null });
    await page.getByRole('alert').waitFor();
    expectComplaint(unanswered);
  });

  it('send what is painted, framed and chosen, and nothing else', async () => {
    const page = await corrections();
    await page.getByRole('button', { name: 'Paint the mask' }).click();
    await stage(page).waitFor();
    await drag(page, [300, 100], [320, 140], [350, 150]);
    await page.getByRole('radio', { name: 'Remove' }).check();
    await page.getByLabel('Brush size').focus();
    for (let press = 0; press < 3; press++) await page.keyboard.press('PageDown');
    await drag(page, [100, 500], [140, 500]);
    await drag(page, [200, 500], [240, 520]);
    await page.keyboard.press('Control+z'); // the focus is on the stage again
    await use(page).click();
    await page.getByText('The mask was edited.').waitFor();

    await page.getByRole('button', { name: 'Paint the body parts' }).click();
    await page.getByRole('radio', { name: 'Torso' }).check();
    await stage(page).focus();
    for (const key of ['ArrowUp', ' ', 'Shift+ArrowLeft', 'Shift+ArrowLeft', 'ArrowUp', ' ', 'ArrowUp']) await page.keyboard.press(key);
    await use(page).click();
    await page.getByLabel('Back of the character').selectOption('Inpainted');
    await page.getByLabel('Left arm').check();
    await page.getByLabel('Camera').selectOption('Slight sway');

    const request = await revised(page);
    const sent = request.postDataJSON();
    expect(sent.options).toEqual({ back_texture: 'inpaint', keep: ['left_arm'], camera: 'parallax' });
    expect(Object.keys(sent.corrections).sort()).toEqual(['label_strokes', 'mask_strokes']);
    const [added, removed, ...others] = sent.corrections.mask_strokes;
    expect([added.person, removed.person, others]).toEqual([true, false, []]);
    expect(added.path[0][0]).toBeCloseTo(300, 0);
    expect(added.path.at(-1)[1]).toBeCloseTo(150, 0);
    expect(added.path.length).toBeGreaterThan(2); // around the corner
    expect(removed.path).toHaveLength(2); // a straight line needs no more
    expect(removed.radius).toBeLessThan(added.radius);
    const [painted] = sent.corrections.label_strokes;
    expect([painted.part, sent.corrections.label_strokes.length, painted.path.length]).toEqual(['torso', 1, 3]);
    await accepted(request);
  });

  it('are made by a finger, too; two bring the picture nearer and paint nothing', async () => {
    const page = await corrections(done, { hasTouch: true, viewport: { width: 390, height: 800 } });
    await page.getByRole('button', { name: 'Paint the mask' }).click();
    await stage(page).waitFor();
    const hand = await page.context().newCDPSession(page);
    const touch = (type: 'touchStart' | 'touchMove' | 'touchEnd', ...points: [number, number][]) =>
      hand.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    const places = await onScreen(page, [[150, 200], [200, 260], [240, 300], [330, 420]]);
    const [a, b, c, d] = [places[0]!, places[1]!, places[2]!, places[3]!];
    const view = () => page.locator('[role=application] > svg').evaluate((svg) => svg.getAttribute('viewBox') ?? '');
    const width = async (): Promise<number> => Number((await view()).split(' ')[2]);
    const undo = page.getByRole('button', { name: 'Undo' });
    const before = await width();
    await touch('touchStart', b);
    await touch('touchStart', b, c);
    await touch('touchMove', a, d);
    await touch('touchEnd');
    await expect.poll(() => width()).toBeLessThan(before);
    const near = await view();
    await expect.poll(() => undo.isDisabled()).toBe(true);
    await touch('touchStart', a);
    await touch('touchMove', b);
    await touch('touchEnd');
    await expect.poll(() => undo.isEnabled()).toBe(true);
    await expect.poll(() => view()).toBe(near);
  });

  it('choose somebody else by a click, or everybody; who was chosen before a box is again after it', async () => {
    const id = await orderCharacter(join(folder, 'two.png'), { ...LIGHT, joints: { LeftElbow: [200, 180] } });
    const page = await corrections(id);
    await page.getByText('2 people were found.').waitFor();
    await page.getByRole('button', { name: 'Person 2 of 2' }).click();
    const chosenNow = page.getByRole('button', { name: 'Person 2 of 2', pressed: true });
    await lacks(page.getByRole('button', { name: 'Paint the mask' }), chosenNow); // that is another's outline
    const request = await revised(page);
    // what was put right of the one is not the other's
    expect(request.postDataJSON()).toEqual({ corrections: { person_index: 1, joints: null }, options: {} });
    await accepted(request);

    const everybody = await corrections(id);
    await everybody.getByRole('button', { name: 'Everyone' }).click();
    const all = everybody.getByRole('button', { name: 'Everyone', pressed: true });
    await lacks(everybody.getByRole('button', { name: /joints/ }), all); // joints are somebody's
    const together = await revised(everybody);
    expect(together.postDataJSON().corrections).toEqual({ person_index: 'all', joints: null });
    await accepted(together);

    const boxed = await corrections(id);
    const chosen = boxed.getByRole('button', { name: /^Person/, pressed: true });
    await boxed.getByRole('button', { name: 'Person 2 of 2' }).click();
    await boxed.getByRole('button', { name: 'Select the person' }).click();
    await use(boxed).click();
    await lacks(chosen, boxed.getByText('The person was selected by hand.'));
    await boxed.getByRole('button', { name: 'Search the whole picture' }).click();
    await expect.poll(() => chosen.getAttribute('aria-label')).toBe('Person 2 of 2');
  });

  it('frame the person', async () => {
    const page = await corrections();
    await page.getByRole('button', { name: 'Select the person' }).click();
    await stage(page).waitFor();
    await drag(page, [4, 4], [100, 80], [400, 560]);
    await stage(page).focus();
    await page.keyboard.press('Shift+ArrowRight');
    await page.keyboard.press('Control+z');
    await use(page).click();
    await page.getByText('The person was selected by hand.').waitFor();
    const request = await revised(page);
    const { corrections: sent } = request.postDataJSON();
    expect(Object.keys(sent)).toEqual(['person_box']);
    [4, 4, 396, 556].forEach((value, index) => expect(Math.abs(sent.person_box[index] - value)).toBeLessThanOrEqual(2));
    await accepted(request);
  });

  it('are asked for where nobody was found, with a skeleton to begin with', async () => {
    const id = finished.noPerson;
    const page = await openStill(browser, `#/jobs/${id}`);
    await page.getByText('No person was found', { exact: true }).waitFor({ timeout: LONG });
    await page.getByText('Correct and try again').click();
    await expect.poll(() => page.getByRole('button', { name: 'Make it again' }).isDisabled()).toBe(true); // the same would fail again
    await page.getByRole('img', { name: 'The uploaded picture' }).last().waitFor();
    await page.getByRole('button', { name: 'Place the joints by hand' }).click();
    await stage(page).focus();
    for (const key of ['ArrowDown', 'ArrowUp']) await page.keyboard.press(key);
    await page.getByLabel('Whole skeleton').uncheck();
    await expect.poll(() => stage(page).getByRole('button').count()).toBe(12);
    await use(page).click();
    await page.getByText('12 joints are placed by hand.').waitFor();
    const sent = await revision(page);
    expect(Object.keys(sent.corrections)).toEqual(['joints']);
    expect(Object.keys(sent.corrections.joints)).toHaveLength(12);
    await page.waitForURL((url) => url.hash.startsWith('#/jobs/') && !url.hash.endsWith(id));
    await page.getByRole('button', { name: 'Cancel' }).or(page.getByRole('link', { name: 'Make another' })).waitFor();
  });
});

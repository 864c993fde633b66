/** Which joint of a motion moves which of a character's: shown and said otherwise, before a job, in a revision, after a failure. */

import './characters_only';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints } from './complaints';
import { accepted, isOrder, launchIn3D, openCorrections, openStill, revised } from './character_kit';
import { LONG } from './jobs';
import { lacks } from './lacks';
import { inPython, media } from './media';
import { address, finished, somebody } from './own_service';
import { ask } from './page';

/** A motion of the tests' own, one that is nobody's, and the names that the engine has. */
const MADE = `
import json, sys
from pathlib import Path
sys.path.insert(0, "tests/live_service")
from made_motion import bvh
from engine.motion.retargeting.joint_map import REQUIRED_MOTION_JOINTS
from engine.motion.retargeting.joint_names import TARGET_NAMES
Path(sys.argv[1]).write_bytes(bvh())
print(json.dumps([TARGET_NAMES, REQUIRED_MOTION_JOINTS]))
`;
const WHIP = `HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Tail
  {
    OFFSET 0 -10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -40 0
    }
  }
}
MOTION
Frames: 1
Frame Time: 0.04
0 100 0 0 0 0 0 0 0
`;

const folder = mkdtempSync(join(tmpdir(), 'galatea-motions-'));
const [swing, whip] = ['swing.bvh', 'whip.bvh'].map((name) => join(folder, name)) as [string, string];
let browser: Browser;
let names: [ours: string[], required: string[]];
beforeAll(async () => {
  browser = await launchIn3D();
  names = JSON.parse(inPython(MADE, swing)) as typeof names;
  writeFileSync(whip, WHIP);
});
afterAll(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const table = (page: Page) => page.getByText('Joints of the motion');
const mover = (page: Page, joint: string) => page.getByRole('combobox', { name: joint, exact: true });
const wanting = (page: Page) => page.getByRole('status').filter({ hasText: 'These joints are required' });

/** The finished character, moved by a file. */
async function moving(motion: string): Promise<string> {
  const body = new FormData();
  body.append('motion', new File([readFileSync(motion)], 'motion.bvh'));
  const response = await fetch(`${address}/v1/jobs/${finished.character}/revisions`, { method: 'POST', body });
  return ((await response.json()) as { id: string }).id;
}

const checks = async (): Promise<number> =>
  (await ask<{ items: object[] }>('/v1/jobs?kind=motion')).items.length;

describe('the joints of a motion', () => {
  it('are those that the engine knows', async () => {
    const { groups, required } = await import('@web/motion/joint_mapping');
    expect(Object.values(groups).flat().sort()).toEqual([...names[0]].sort());
    expect([...required].sort()).toEqual([...names[1]].sort());
  });

  it('of a file are looked into before anything is ordered; what is as found is not sent', async () => {
    const before = await checks();
    const page = await openStill(browser, '#/character');
    await lacks(table(page), page.getByRole('radio', { name: 'Walk', exact: true })); // our own clips know their joints
    await page.getByLabel(/Drop a picture/).setInputFiles(somebody);
    await page.getByLabel(/Drop a BVH/).setInputFiles(swing);
    await table(page).click();
    await mover(page, 'Left upper arm').waitFor({ timeout: LONG });
    await expect.poll(() => mover(page, 'Left upper arm').inputValue()).toBe('LeftArm');
    await expect.poll(checks, { timeout: LONG }).toBe(before); // the look leaves nothing behind
    await mover(page, 'Left upper arm').selectOption('LeftForeArm');
    await mover(page, 'Neck').selectOption('None');
    await mover(page, 'Head').selectOption('Neck');
    await page.getByText('3 changed').waitFor();
    await mover(page, 'Head').selectOption('Head');
    await page.getByText('2 changed').waitFor();
    const [request] = await Promise.all([
      page.waitForRequest(isOrder),
      page.getByRole('button', { name: 'Create character' }).click(),
    ]);
    expect(request.postDataJSON().options).toEqual({ motion_joints: { LeftArm: 'LeftForeArm', Neck: null } });
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.getByText('This job was canceled before it was done').waitFor();
  });

  it('are shown in the corrections, and of another motion as that has them', async () => {
    const id = await moving(swing);
    const page = await openStill(browser, `#/jobs/${id}`);
    await openCorrections(page);
    await table(page).click();
    await mover(page, 'Right lower leg').waitFor({ timeout: LONG });
    await mover(page, 'Right lower leg').selectOption('LeftLeg');
    await page.getByText('Fingers', { exact: true }).click();
    await mover(page, 'Left thumb, 1').selectOption('LeftHand');
    const request = await revised(page);
    expect(request.postDataJSON()).toMatchObject({
      corrections: { motion_joints: { RightLeg: 'LeftLeg', LeftHandThumb1: 'LeftHand' } },
      options: {},
    });
    await accepted(request);
  });

  it('come with the animations of a file, of which one can be chosen', async ({ skip }) => {
    const soldier = media('scans3d/body_soldier/soldier.glb') ?? skip('the shared test media are not here');
    const page = await openStill(browser, '#/character');
    await page.getByLabel(/Drop a picture/).setInputFiles(somebody);
    await page.getByLabel(/Drop a BVH/).setInputFiles(soldier);
    await table(page).click();
    const animation = page.getByRole('combobox', { name: 'Animation', exact: true });
    await animation.waitFor({ timeout: LONG });
    await expect.poll(() => animation.locator('option').allInnerTexts()).toEqual(['First animated one', 'Idle', 'Run', 'TPose', 'Walk']);
    await animation.selectOption('Run');
    const [request] = await Promise.all([
      page.waitForRequest(isOrder),
      page.getByRole('button', { name: 'Create character' }).click(),
    ]);
    expect(request.postDataJSON().options).toEqual({ motion_clip: 'Run' });
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.getByText('This job was canceled before it was done').waitFor();
  });

  it('are asked for where a motion was nobody’s', async () => {
    const id = await moving(whip);
    const page = await openStill(browser, `#/jobs/${id}`);
    await page.getByText('The motion is not of a person', { exact: true }).waitFor({ timeout: LONG });
    await wanting(page).filter({ hasText: 'Left thigh' }).waitFor();
    await expect.poll(() => mover(page, 'Hips').inputValue()).toBe('Hips');
    await mover(page, 'Left thigh').selectOption('Tail');
    await expect.poll(() => wanting(page).innerText()).not.toContain('Left thigh');
    const request = await revised(page);
    expect(request.postDataJSON().corrections).toEqual({ motion_joints: { LeftUpLeg: 'Tail' } });
    await accepted(request);
  });
});

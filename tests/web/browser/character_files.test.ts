/** A mask and a map of the parts, given as files in place of what was found. */

import './characters_only';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints } from './complaints';
import { accepted, again, launchIn3D, openCorrections, openStill, revised } from './character_kit';
import { LONG } from './jobs';
import { inPython } from './media';
import { address, finished, somebody } from './own_service';
import { ask } from './page';

/** A mask of a picture's size, and one that is too small. */
const MASKS = `
import sys
from PIL import Image, ImageDraw
size = Image.open(sys.argv[1]).size
mask = Image.new("L", size)
ImageDraw.Draw(mask).ellipse([0.3 * size[0], 0.1 * size[1], 0.7 * size[0], 0.97 * size[1]], fill=255)
mask.save(sys.argv[2])
mask.resize((200, 300)).save(sys.argv[3])
`;

const folder = mkdtempSync(join(tmpdir(), 'galatea-files-'));
const [mask, small] = ['mask.png', 'small.png'].map((name) => join(folder, name)) as [string, string];
let browser: Browser;
const done = finished.character;
beforeAll(async () => {
  browser = await launchIn3D();
  inPython(MASKS, somebody, mask, small);
});
afterAll(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const file = (page: Page, of: 'Mask' | 'Body parts') => page.getByLabel(`${of} from a file`);

async function corrections(id = done): Promise<Page> {
  const page = await openStill(browser, `#/jobs/${id}`);
  await openCorrections(page);
  return page;
}

describe('a mask from a file', () => {
  it('has to be as large as the picture, and to be a picture', async () => {
    const page = await corrections();
    await file(page, 'Mask').setInputFiles(small);
    await page.getByRole('alert').getByText('“small.png” has 200 × 300 pixels.').waitFor();
    await page.getByText('as large as the picture: 450 × 600.').waitFor();
    await file(page, 'Mask').setInputFiles({ name: 'a.png', mimeType: 'image/png', buffer: Buffer.from('x') });
    await page.getByRole('alert').getByText('cannot read “a.png”').waitFor();
    await expect.poll(() => again(page).isDisabled()).toBe(true);
  });

  it('is sent with what is painted over it, stays in what comes of it, and can be taken back', async () => {
    const page = await corrections();
    await file(page, 'Mask').setInputFiles(mask);
    await page.getByText('“mask.png” is used instead of the detected one.').waitFor();
    await file(page, 'Body parts').setInputFiles(mask);
    const forget = page.getByRole('button', { name: 'Remove the file' });
    await expect.poll(() => forget.count()).toBe(2);
    await forget.last().click();
    await page.getByRole('button', { name: 'Paint the mask' }).click();
    await page.getByRole('dialog').getByRole('application').focus();
    for (const key of [' ', 'Shift+ArrowUp', ' ']) await page.keyboard.press(key);
    await page.getByRole('button', { name: 'Apply' }).click();
    const request = await revised(page);
    const { corrections: sent, options } = request.postDataJSON();
    expect([Object.keys(sent).sort(), options]).toEqual([['mask', 'mask_strokes'], {}]);
    const kept = await ask<{ content_type: string }>(`/v1/files/${sent.mask}`);
    expect(kept.content_type).toBe('image/png');

    await page.waitForURL((url) => url.hash.startsWith('#/jobs/') && !url.hash.endsWith(done));
    await openCorrections(page);
    await page.getByText('Your file is used instead of the detected one.').waitFor();
    await page.getByRole('button', { name: 'Remove the file' }).click();
    const back = await revised(page);
    expect(back.postDataJSON().corrections).toEqual({ mask: null, mask_strokes: null });
    await accepted(back);
  });

  it('that the service refuses is told in its words, and another can be given', async () => {
    const body = new FormData();
    const { readFileSync } = await import('node:fs');
    body.append('mask', new File([readFileSync(small)], 'small.png'));
    const response = await fetch(`${address}/v1/jobs/${done}/revisions`, { method: 'POST', body });
    const { id } = (await response.json()) as { id: string };
    const page = await openStill(browser, `#/jobs/${id}`);
    await page.getByText('The mask is not as large as the picture', { exact: true }).waitFor({ timeout: LONG });
    await page.getByText('make it as large as the picture, 450 x 600').waitFor();
    await file(page, 'Mask').setInputFiles(mask);
    await page.getByText('“mask.png” is used instead of the detected one.').waitFor();
    const request = await revised(page);
    expect(Object.keys(request.postDataJSON().corrections)).toEqual(['mask']);
    await accepted(request);
  });
});

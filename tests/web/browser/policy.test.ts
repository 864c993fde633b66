/** What the page may do in a browser (its Content-Security-Policy). All tests that `open` a page hold it to that; characters
 * in 3D are in `character.test.ts`. */

import './nobody_works';
import { readdirSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { resolve } from 'node:path';
import type { Browser } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints } from './complaints';
import { launch } from './browser';
import { address, finished } from './own_service';
import { open } from './page';

let browser: Browser;
const job = finished.portrait;
beforeAll(async () => {
  browser = await launch();
});
afterAll(async () => {
  await browser.close();
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
});

const shared = async (id: string): Promise<string> => {
  const made = await fetch(`${address}/v1/jobs/${id}/links`, {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: '{}',
  });
  return new URL(((await made.json()) as { page: string }).page, address).hash;
};

describe('no page does what it may not', () => {
  const pages: [string, () => Promise<string>][] = [
    ['the studio', async () => '#/'],
    ['characters', async () => '#/character'],
    ['the history', async () => '#/history'],
    ['keys', async () => '#/keys'],
    ['webhooks', async () => '#/webhooks'],
    ['a portrait', async () => `#/jobs/${job}`],
    ['a portrait that is shared', async () => shared(job)],
  ];
  it.each(pages)('%s', async (_, hash) => {
    const page = await open(browser, await hash());
    await page.getByRole('heading').first().waitFor();
    await page.waitForLoadState('networkidle');
    expect(complaints.splice(0)).toEqual([]);
  });

  it('what shows a character in a room, where there is AR', async () => {
    const page = await open(browser);
    const part = readdirSync(resolve(import.meta.dirname, '../../../web/dist/assets')).find((name) => /^ar_dialog-.*\.js$/.test(name));
    expect(part, 'the part of the page for AR').toBeDefined();
    await page.addScriptTag({ url: `/assets/${part}`, type: 'module' });
    await page.evaluate(() => document.body.append(document.createElement('model-viewer')));
    await page.waitForFunction(() => getComputedStyle(document.querySelector('model-viewer')!).display === 'block');
    await page.waitForLoadState('networkidle');
    expect(complaints.splice(0)).toEqual([]);
  });
});

describe('what is not allowed', () => {
  it('is told by the browser, and fails the test', async () => {
    const page = await open(browser);
    await page.evaluate(() => {
      const script = document.createElement('script');
      script.textContent = 'window.foreign = true';
      document.body.append(script);
    });
    await expect.poll(() => complaints.some((text) => text.startsWith('not allowed: script-src'))).toBe(true);
    await expect.poll(() => page.evaluate(() => 'foreign' in window)).toBe(false);
  });

  it('is to show the page in a frame', async () => {
    const frames = createServer((_, response) => {
      response.setHeader('Content-Type', 'text/html');
      response.end(`<iframe src="${address}/"></iframe>`);
    });
    await new Promise<void>((ready) => frames.listen(0, '127.0.0.1', ready));
    try {
      const page = await browser.newPage();
      const refused = page.waitForEvent('console', (message) => message.text().includes('frame-ancestors'));
      await page.goto(`http://127.0.0.1:${((frames as Server).address() as AddressInfo).port}/`);
      await refused;
    } finally {
      frames.close();
    }
  });
});

it('shows a result that is opened by itself, in which nothing runs', async () => {
  const page = await browser.newPage();
  for (const name of ['animation.mp4', 'poster.jpg']) {
    await page.goto(`${address}/v1/jobs/${job}/artifacts/${name}`);
    await page.waitForFunction(() => {
      const video = document.querySelector('video');
      return (video?.videoWidth ?? document.querySelector('img')?.naturalWidth ?? 0) > 0;
    });
  }
});

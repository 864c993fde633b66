/** What the browser tests share: a browser, real media, and a job that was ordered over the API. */

import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { type Browser, chromium, type Page } from 'playwright-core';
import { expect, inject } from 'vitest';

const root = resolve(import.meta.dirname, '../../..');
const python = join(root, '.venv/bin/python');

const flags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

export const launch = (): Promise<Browser> =>
  chromium.launch({ executablePath: process.env.GALATEA_CHROMIUM ?? '/usr/bin/chromium', args: flags });

/** A portrait that comes with matplotlib. */
export const portrait = execFileSync(python, [
  '-c',
  'import matplotlib, pathlib; print(pathlib.Path(matplotlib.__file__).parent / "mpl-data/sample_data/grace_hopper.jpg")',
])
  .toString()
  .trim();

/** A picture without a face, from the same place. */
export const faceless = join(portrait, '../Minduka_Present_Blue_Pack.png');

/** Open the page. What the browser complains of fails the test at its end: see `complaints`. */
export async function open(browser: Browser, hash = '', options: Parameters<Browser['newPage']>[0] = {}): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  complaints.length = 0;
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));
  await page.goto(`${inject('address')}/${hash}`);
  return page;
}

/** Errors that scripts and the network left in the console of the page that was opened last. */
export const complaints: string[] = [];

/** Order a portrait over the API, as any other client would; the job's id. */
export async function order(image: string, driver: string): Promise<string> {
  const address = inject('address');
  const body = new FormData();
  body.append('kind', 'portrait');
  body.append('image', new Blob([readFileSync(image)]), image.split('/').at(-1));
  body.append('driver', driver);
  const response = await fetch(`${address}/v1/jobs`, { method: 'POST', body });
  expect(response.status, await response.clone().text()).toBe(202);
  return ((await response.json()) as { id: string }).id;
}

const mediaFolder = process.env.GALATEA_TEST_DATA ?? resolve(root, '../shared/data');

/** A file of the shared test media, which are kept outside the project; null where they are absent (never in CI). */
export function media(name: string): string | null {
  const path = join(mediaFolder, name);
  if (existsSync(path)) return path;
  if (process.env.CI === 'true') throw new Error(`test media not found: ${path} (set GALATEA_TEST_DATA)`);
  return null;
}

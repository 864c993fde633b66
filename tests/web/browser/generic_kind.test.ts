/** A kind of job that the page does not know, against a service that has it: first without a folder here, then with one. */

import { execFileSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { launch } from './browser';
import { complaints, watch } from './complaints';
import { LONG } from './jobs';
import { portrait } from './media';
import { serve } from './service';

const root = resolve(import.meta.dirname, '../../..');

let browser: Browser;
let service: Awaited<ReturnType<typeof serve>>;
beforeAll(async () => {
  browser = await launch();
  service = await serve({
    GALATEA_KINDS: 'tiny_kind:KIND',
    GALATEA_DISK_RESERVE_MB: '1',
    PYTHONPATH: [resolve(root, 'tests/live_service'), root].join(':'),
  });
});
afterAll(async () => {
  await service?.end();
  await browser.close();
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

/** The page at this address; `folder`: where it is built, if not where the service has it. */
async function opened(hash: string, folder?: string): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  watch(page);
  if (folder) {
    await page.route(/\/(\?.*|#.*)?$|\/assets\//, (route) => {
      const { pathname } = new URL(route.request().url());
      return route.fulfill({ path: join(folder, pathname === '/' ? 'index.html' : pathname) });
    });
  }
  await page.goto(`${service.address}/${hash}`);
  return page;
}

const ask = async <T,>(path: string): Promise<T> => (await (await fetch(service.address + path)).json()) as T;

const titled = (page: Page, name: string) => page.getByRole('heading', { name, level: 1 });
const makers = (page: Page) => page.getByRole('navigation', { name: 'What to make' }).getByRole('link');
const chooseImage = (page: Page) =>
  page.getByRole('region', { name: 'Image' }).locator('input[type=file]').setInputFiles(portrait);

/** From now on the page waits with the first bytes of files, until what is returned is called. */
async function holdReading(page: Page): Promise<() => Promise<void>> {
  const goOn = await page.evaluateHandle(() => {
    const read = Blob.prototype.arrayBuffer;
    let open = (): void => undefined;
    const opened = new Promise<void>((resolve) => (open = resolve));
    Blob.prototype.arrayBuffer = function (this: Blob) {
      return opened.then(() => read.call(this));
    };
    return () => {
      Blob.prototype.arrayBuffer = read;
      open();
    };
  });
  return () => goOn.evaluate((open) => open());
}

describe('a kind without a folder of its own', () => {
  it('is ordered by a form that its schemas make, followed, shown, found again and shared', async () => {
    const page = await opened('');
    await makers(page).getByText('Tiny').click();
    await titled(page, 'Tiny').waitFor();
    await page.getByText('Measures a picture.').waitFor();
    const start = page.getByRole('button', { name: 'Start' });
    await expect.poll(() => start.isDisabled()).toBe(true);
    await page.getByText('Choose first: Image.').waitFor();
    const letRead = await holdReading(page);
    await chooseImage(page);
    await page.getByRole('region', { name: 'Driver' }).getByLabel('Or by name').selectOption({ label: 'Happy' });
    await letRead(); // the picture comes after the name, and must not lose it
    await page.getByRole('region', { name: 'Options' }).locator('summary').click();
    await page.getByLabel('Level').fill('2.5');
    await page.getByLabel('Polls').uncheck();
    await start.click();

    await titled(page, 'Grace hopper').waitFor();
    await page.getByRole('status').getByText('Done', { exact: true }).waitFor({ state: 'attached', timeout: LONG });
    const id = page.url().split('/').at(-1);
    const job = await ask<Record<string, unknown>>(`/v1/jobs/${id}`);
    expect(job).toMatchObject({ kind: 'tiny', status: 'succeeded', options: { level: 2.5, polls: false } });
    expect(job.inputs).toMatchObject({ driver: 'happy' });
    const film = page.locator('.result video');
    await film.waitFor({ state: 'attached' });
    await expect.poll(() => film.getAttribute('src')).toMatch(/animation\.mp4/);
    await page.locator('.result').getByRole('link', { name: 'animation.mp4' }).waitFor();

    await page.getByRole('button', { name: 'Share', exact: true }).click();
    await page.getByRole('button', { name: 'Create link' }).click();
    const link = await page.getByLabel('Link', { exact: true }).inputValue();
    await page.goto(`${service.address}/#/history`);
    await page.getByRole('link', { name: 'Grace hopper' }).and(page.locator(`[href$="${id}"]`)).waitFor();
    expect(complaints).toEqual([]);

    const guest = await opened(new URL(link).hash);
    await titled(guest, 'A result: Tiny').waitFor();
    await guest.locator('article video').first().waitFor({ state: 'attached' });
    await expect.poll(() => guest.locator('article video').count()).toBe(1); // its animation, and that once
    await expect.poll(() => guest.getByRole('article').getByRole('link').allTextContents()).toEqual(['animation.mp4', 'preview.jpg']);
  });
});

describe('a kind that is a folder more, and a line more in the list', () => {
  let copy: string;
  beforeAll(() => {
    copy = mkdtempSync(join(tmpdir(), 'galatea-kind-'));
    mkdirSync(join(copy, 'docs'));
    const web = join(copy, 'web');
    cpSync(join(root, 'web'), web, { recursive: true, filter: (path) => !/\/web\/(node_modules|dist|reactive)$/.test(path) });
    symlinkSync(join(root, 'web/node_modules'), join(web, 'node_modules'));
    const folder = join(web, 'src/kinds/toy');
    mkdirSync(folder);
    writeFileSync(
      join(folder, 'index.ts'),
      `import { genericKind } from '../generic';
export const toy = { ...genericKind('tiny'), label: 'A toy', link: '#/toy', loadStudio: () => import('./studio') };\n`,
    );
    writeFileSync(
      join(folder, 'studio.tsx'),
      `import GenericStudio from '../generic/studio';
import type { StudioProps } from '../../kind/kind';
export default (props: StudioProps) => <><p>Toys are made here.</p><GenericStudio {...props} /></>;\n`,
    );
    const list = join(web, 'src/kinds/index.ts');
    const kinds = readFileSync(list, 'utf8').replace(/(\['all'\] = \[[^\]]+)\]/, '$1, toy]');
    writeFileSync(list, `import { toy } from './toy';\n${kinds}`);
    execFileSync(join(web, 'node_modules/.bin/vite'), ['build', '--logLevel', 'error'], { cwd: web });
  });
  afterAll(() => rmSync(copy, { recursive: true, force: true }));

  it('has a studio of its own at an address of its own, and what it leaves out is drawn from the schemas', async () => {
    const page = await opened('#/toy', join(copy, 'web/dist'));
    await titled(page, 'A toy').waitFor();
    await page.getByText('Toys are made here.').waitFor();
    await expect.poll(() => makers(page).allTextContents()).toEqual(['A toy']);
    await chooseImage(page);
    await page.getByRole('button', { name: 'Start' }).click();
    await page.getByRole('status').getByText('Done', { exact: true }).waitFor({ state: 'attached', timeout: LONG });
    await page.locator('article footer').getByRole('link').and(page.locator('[href="#/toy"]')).waitFor(); // the way back
  });
});

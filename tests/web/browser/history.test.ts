import './nobody_works';
import { readFileSync } from 'node:fs';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { answered, complaints, expectComplaint } from './complaints';
import { readable } from './axe';
import { launch } from './browser';
import { lacks } from './lacks';
import { faceless } from './media';
import { address } from './own_service';
import { open } from './page';

interface Job {
  id: string;
  title: string | null;
}

let browser: Browser;
let key: { id: string; token: string };
beforeAll(async () => {
  browser = await launch();
  // A key sees what belongs to it alone, so that the history begins empty here.
  const body = JSON.stringify({ name: 'history', scopes: ['read', 'submit'], expires_in_days: 1 });
  key = (await (await fetch(`${address}/v1/keys`, { method: 'POST', headers: json, body })).json()) as typeof key;
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const json = { 'Content-Type': 'application/json' };
const bearer = (): Record<string, string> => ({ Authorization: `Bearer ${key.token}` });

async function send<T>(method: string, path: string, body?: object | FormData): Promise<T> {
  const form = body instanceof FormData;
  const response = await fetch(`${address}${path}`, {
    method,
    headers: { ...bearer(), ...(form ? {} : json) },
    ...(body && { body: form ? body : JSON.stringify(body) }),
  });
  expect(response.ok, await response.clone().text()).toBe(true);
  return (await response.json()) as T;
}

/** Jobs that end at once: all that is looked at here is what the history says of them. */
const ended = async (job: Promise<Job>): Promise<Job> => send('POST', `/v1/jobs/${(await job).id}/cancel`);

let image: string | null = null;
async function work(title: string | null, portrait = 'Present'): Promise<Job> {
  if (image === null) {
    const form = new FormData();
    form.append('file', new File([readFileSync(faceless)], 'present.png'));
    image = (await send<{ id: string }>('POST', '/v1/files', form)).id;
  }
  const inputs = { image, driver: 'happy' };
  return ended(send('POST', '/v1/jobs', { kind: 'portrait', inputs, title, metadata: { portrait } }));
}
const revision = (job: Job, options: object): Promise<Job> =>
  ended(send('POST', `/v1/jobs/${job.id}/revisions`, { options }));

const history = (hash = '#/history'): Promise<Page> => open(browser, hash, { extraHTTPHeaders: bearer() });
const works = (page: Page) => page.locator('.work');
const names = (page: Page): Promise<string[]> => page.locator('.work .name').allTextContents();
const search = (page: Page) => page.getByRole('searchbox', { name: 'Search' });
const settled = (page: Page, expected: string[]) => expect.poll(() => names(page)).toEqual(expected);

describe('the history', () => {
  it('says that there is nothing yet, which is another thing than nothing found', async () => {
    const page = await history();
    await page.getByRole('heading', { name: 'Nothing here yet' }).waitFor();
    await expect.poll(() => page.getByRole('link', { name: 'Make a portrait' }).getAttribute('href')).toBe('#/');
    await search(page).fill('anything');
    await page.getByRole('heading', { name: 'Nothing found for “anything”' }).waitFor();
    await page.getByText('A search looks at titles').waitFor();
    await readable(page);
    await page.getByRole('link', { name: 'Clear search' }).click();
    await page.getByRole('heading', { name: 'Nothing here yet' }).waitFor();
    await expect.poll(() => search(page).inputValue()).toBe('');
    await page.getByRole('link', { name: 'Failed' }).click();
    await page.getByRole('heading', { name: 'Nothing with this status' }).waitFor();
  });

  it('finds works by words, which the address keeps for a reload and for the way back', async () => {
    await work('Aunt Mary');
    await work('Aunt Agatha');
    const page = await history();
    await settled(page, ['Aunt Agatha', 'Aunt Mary']);
    const before = await page.evaluate(() => window.history.length);
    await search(page).pressSequentially('AUNT mar');
    await settled(page, ['Aunt Mary']);
    await page.waitForURL(/#\/history\?q=AUNT%20mar$/);
    await expect.poll(() => page.evaluate(() => window.history.length), { message: 'no step for each letter' }).toBe(before);
    await page.getByRole('status').getByText('1 found').waitFor();
    await page.reload();
    await settled(page, ['Aunt Mary']);
    await expect.poll(() => search(page).inputValue()).toBe('AUNT mar');

    await page.getByRole('link', { name: 'Aunt Mary' }).click();
    await page.getByRole('heading', { name: 'Aunt Mary' }).waitFor();
    await page.goBack();
    await settled(page, ['Aunt Mary']);
    await expect.poll(() => search(page).inputValue()).toBe('AUNT mar');
    await page.getByRole('link', { name: 'Canceled' }).click();
    await page.waitForURL(/#\/history\/canceled\?q=AUNT%20mar$/);
    await settled(page, ['Aunt Mary']);
    await page.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name: 'History' }).click();
    await settled(page, ['Aunt Agatha', 'Aunt Mary']);
    await expect.poll(() => search(page).inputValue()).toBe('');
  });

  it('gives a work a title where it stands, by the keyboard alone, and takes it away again', async () => {
    const { id } = await work(null, 'IMG 1931');
    const page = await history('#/history?q=present');
    const pencil = page.getByRole('button', { name: 'Rename: IMG 1931' });
    await pencil.focus();
    await page.keyboard.press('Enter');
    const field = page.getByRole('textbox', { name: 'Title of “IMG 1931”' });
    const state = () =>
      field.evaluate((input: HTMLInputElement) => [input === document.activeElement, input.value, input.selectionEnd]);
    await expect.poll(state).toEqual([true, 'IMG 1931', 8]);
    await page.keyboard.press('Escape');
    await field.waitFor({ state: 'detached' });
    await expect.poll(() => focused(page)).toBe('Rename: IMG 1931');

    await page.keyboard.press('Enter');
    await page.keyboard.type('Uncle Bob');
    await page.keyboard.press('Enter');
    await page.getByRole('link', { name: 'Uncle Bob' }).waitFor();
    await expect.poll(() => focused(page)).toBe('Rename: Uncle Bob');
    const kept = async (): Promise<string | null> => (await send<Job>('GET', `/v1/jobs/${id}`)).title;
    await expect.poll(kept).toBe('Uncle Bob');

    await page.getByRole('link', { name: 'Uncle Bob' }).click();
    await page.getByRole('heading', { name: 'Uncle Bob', level: 1 }).waitFor();
    await page.getByRole('button', { name: 'Rename: Uncle Bob' }).click();
    await page.getByRole('textbox', { name: 'Title of “Uncle Bob”' }).fill('');
    await page.getByRole('button', { name: 'Save' }).click();
    await page.getByRole('heading', { name: 'IMG 1931', level: 1 }).waitFor();
    await expect.poll(() => focused(page)).toBe('Rename: IMG 1931');
    await expect.poll(() => page.title()).toContain('IMG 1931');
    await expect.poll(kept).toBe(null);
  });

  it('says beside the field why a title was refused, and keeps what was typed', async () => {
    await work('Tab');
    const page = await history('#/history?q=tab');
    await page.getByRole('button', { name: 'Rename: Tab' }).click();
    const field = page.getByRole('textbox', { name: 'Title of “Tab”' });
    await field.fill('a\u007fb');
    await field.press('Enter');
    const error = page.getByRole('alert');
    await error.waitFor();
    await expect.poll(() => field.getAttribute('aria-invalid')).toBe('true');
    await expect.poll(() => field.inputValue()).toBe('a\u007fb');
    await expect.poll(async () => (await field.getAttribute('aria-describedby')) === (await error.getAttribute('id'))).toBe(true);
    await expect.poll(() => field.evaluate((input) => input === document.activeElement)).toBe(true);
    await readable(page);
    expectComplaint(answered(422));
  });

  it('shows a work once, its other versions beneath, with what each changed', async () => {
    const first = await work('Versions');
    const second = await revision(first, { strength: 1.5, loop: true });
    await work('Between');
    const third = await revision(second, { strength: 0.5 });
    const page = await history('#/history?q=e');
    await expect.poll(async () => (await names(page)).slice(0, 2)).toEqual(['Versions', 'Between']);
    const shown = works(page).first();
    await expect.poll(() => shown.getByRole('link').first().getAttribute('href')).toBe(`#/jobs/${third.id}`);
    const fold = shown.locator('summary');
    await expect.poll(() => fold.textContent()).toBe('2 other versions of “Versions”');
    await fold.click();
    await expect.poll(() => shown.locator('.other-versions li').allInnerTexts()).toHaveLength(2);
    const others = () => shown.locator('.other-versions a').evaluateAll((links) => links.map((link) => link.getAttribute('href')));
    await expect.poll(others).toEqual([`#/jobs/${second.id}`, `#/jobs/${first.id}`]);
    await expect.poll(() => shown.locator('.other-versions li').allTextContents()).toEqual([
      expect.stringContaining('Version 2Changed: strength (150%), loop'),
      expect.stringContaining('Version 1The first version'),
    ]);
    await expect.poll(() => shown.locator('.other-versions p').textContent()).toBe('Shown: version 3 Changed: strength (50%)');
    const between = works(page).filter({ hasText: 'Between' });
    await lacks(between.locator('summary'), between);
    await page.getByRole('button', { name: 'Rename: Between' }).click();
    await readable(page);
  });

  it('leads page by page through all works, each of them once, however its versions are spread', async () => {
    const oldest = await work('Page 00');
    for (let number = 1; number < 25; number++) await work(`Page ${String(number).padStart(2, '0')}`);
    await revision(oldest, { loop: true });
    const page = await history('#/history?q=page');
    await expect.poll(() => works(page).count()).toBe(24);
    await expect.poll(async () => (await names(page)).slice(0, 2)).toEqual(['Page 00', 'Page 24']);
    await page.getByRole('status').getByText('More than 24 found').waitFor();
    await page.getByRole('button', { name: 'Show more' }).click();
    await expect.poll(() => works(page).count()).toBe(25);
    await expect.poll(async () => new Set(await names(page)).size).toBe(25);
    await expect.poll(async () => (await names(page)).at(-1)).toBe('Page 01');
    await lacks(page.getByRole('button', { name: 'Show more' }), works(page).nth(24));
    await lacks(page.locator('.work img:not([loading="lazy"])'), works(page).nth(24));
  });
});

const focused = (page: Page): Promise<string | null> =>
  page.evaluate(() => document.activeElement?.getAttribute('aria-label') ?? document.activeElement?.textContent ?? null);

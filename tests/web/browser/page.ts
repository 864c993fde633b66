/** What the browser tests share: the page of the file's own service, open in a browser, and jobs that were ordered over the API. */

import type { Browser, Page } from 'playwright-core';
import { expect } from 'vitest';
import { watch } from './complaints';
import { lacks } from './lacks';
import { LONG, SMALL, orderCharacter as character, orderPortrait as portraitOf } from './jobs';
import { lengthyPerformance, portrait } from './media';
import { address } from './own_service';

/**
 * Open the page. What the browser complains of fails the test at its end: see `complaints`. So does what the page's policy
 * (CSP) does not allow. `script` runs in the page before its own do.
 */
export async function open(
  browser: Browser,
  hash = '',
  options: Parameters<Browser['newPage']>[0] = {},
  script?: () => void,
): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  watch(page);
  await page.addInitScript(() =>
    addEventListener('securitypolicyviolation', ({ violatedDirective, blockedURI, sourceFile, lineNumber }) =>
      console.error(`not allowed: ${violatedDirective}, ${blockedURI} (${sourceFile}:${lineNumber})`),
    ),
  );
  if (script) await page.addInitScript(script);
  await page.goto(`${address}/${hash}`);
  return page;
}

/** Asks the service as any other client would; JSON. */
export const ask = async <T,>(path: string): Promise<T> => (await (await fetch(address + path)).json()) as T;

/**
 * Holds that the page offers no upload of before to go on with. It asks the browser whether one is kept, which takes a
 * while, and shows nothing where none is: so it is what the browser keeps that is looked at, after the page has asked.
 */
export async function nothingToResume(page: Page): Promise<void> {
  await page.getByRole('radio').first().waitFor({ state: 'attached' });
  const kept = () =>
    page.evaluate(
      () =>
        new Promise<number>((done, fail) => {
          const opening = indexedDB.open('galatea');
          opening.onerror = () => fail(opening.error);
          opening.onsuccess = () => {
            const counting = opening.result.transaction('orders').objectStore('orders').count();
            counting.onerror = () => fail(counting.error);
            counting.onsuccess = () => {
              opening.result.close();
              done(counting.result);
            };
          };
        }),
    );
  await expect.poll(kept, { message: 'orders that the browser keeps' }).toBe(0);
  await lacks(page.getByRole('button', { name: 'Resume upload' }), page.getByRole('radio'));
}

/** A job's id, from the address of its page. */
export const jobOf = (page: Page): string => page.url().split('/').at(-1) ?? '';

/** Waits for a job's result on its page, and until its video has really played a little. */
export async function played(page: Page): Promise<void> {
  await page.getByRole('region', { name: 'Result and performance' }).waitFor({ timeout: LONG });
  await page.waitForFunction(() => {
    const video = document.querySelector('video');
    return video && video.videoWidth > 0 && (video.currentTime > 0.2 || video.ended);
  });
}

/** Order a portrait over the API, as any other client would; the job's id. */
export const order = (image: string, driver: string | File | null, options: object = {}): Promise<string> =>
  portraitOf(address, image, driver, options);

/** Order a character likewise. */
export const orderCharacter = (photo: string, options: object = {}): Promise<string> =>
  character(address, photo, options);

/** Cancels what is queued or at work: nobody looks at it any more, and what comes next would wait for it. */
export async function cancelAll(): Promise<void> {
  const { items } = await ask<{ items: { id: string }[] }>('/v1/jobs?status=queued&status=running&limit=200');
  // one that has just ended is none to cancel
  await Promise.all(items.map(({ id }) => fetch(`${address}/v1/jobs/${id}/cancel`, { method: 'POST' })));
}

let lengthy: Promise<File> | undefined;

/**
 * The page of a job that waits for one before it, and what lets it begin: whatever it shows on its way is seen by a page that
 * is there, however fast the machine is and however short the job.
 */
export async function openWaiting(browser: Browser, driver: string): Promise<{ page: Page; begin: () => Promise<void> }> {
  const before = await order(portrait, await (lengthy ??= lengthyPerformance()), SMALL);
  const job = await order(portrait, driver, SMALL);
  const page = await open(browser, `#/jobs/${job}`);
  await page.getByText(/^(Next|Place \d) in the queue$/).waitFor();
  const begin = async (): Promise<void> => {
    expect((await fetch(`${address}/v1/jobs/${before}/cancel`, { method: 'POST' })).ok).toBe(true);
  };
  return { page, begin };
}

/**
 * The page of a job that takes a while, opened while the job waits or has just begun: what it shows on the way can be
 * watched, however fast the machine is. It waits for as many like it as are to be `ahead`.
 */
export async function openRunning(browser: Browser, ahead = 0): Promise<Page> {
  const page = await open(browser);
  await page.getByRole('radio').first().waitFor({ state: 'attached' });
  const performance = await (lengthy ??= lengthyPerformance());
  for (let one = 0; one < ahead; one++) await order(portrait, performance);
  const job = await order(portrait, performance);
  await page.evaluate((id) => (location.hash = `#/jobs/${id}`), job);
  return page;
}

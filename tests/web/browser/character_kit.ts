/** What the tests of characters share: the page of a finished one with its corrections open, and what it sends. */

import type { Browser, Page, Request } from 'playwright-core';
import { expect } from 'vitest';
import { launch } from './browser';
import { LONG } from './jobs';
import { address } from './own_service';
import { open } from './page';

export const again = (page: Page) => page.getByRole('button', { name: 'Make it again' });
export const isOrder = (request: Request): boolean => request.method() === 'POST' && request.url().endsWith('/v1/jobs');
export const isRevision = (request: Request): boolean =>
  request.method() === 'POST' && request.url().endsWith('/revisions');

/** A browser that shows 3D on any machine. */
export const launchIn3D = (): Promise<Browser> => launch(['--enable-unsafe-swiftshader']);

/**
 * The page for who wants stillness: the character does not walk, which costs much where there is no graphics card, as every
 * pixel does that is drawn of them.
 */
export const openStill = (browser: Browser, hash = '', options: Parameters<Browser['newPage']>[0] = {}): Promise<Page> =>
  open(browser, hash, { reducedMotion: 'reduce', deviceScaleFactor: 0.5, ...options });

/** Until the character is made, and shown on its page. */
export const isMade = (page: Page): Promise<void> => page.getByRole('region', { name: 'In 3D' }).waitFor({ timeout: LONG });

/** Opens the corrections of a character on its page, once it is made. */
export async function openCorrections(page: Page): Promise<void> {
  await isMade(page);
  await page.getByText('Edit and make again').click();
}

/** The request that a click on “Make it again” sends. */
export async function revised(page: Page): Promise<Request> {
  const [request] = await Promise.all([page.waitForRequest(isRevision), again(page).click()]);
  return request;
}

/** The service accepts a revision; its work is not what the test is about. */
export async function accepted(request: Request): Promise<void> {
  const response = await request.response();
  expect(response?.status(), await response?.text()).toBe(202);
  const { id } = (await response!.json()) as { id: string };
  await fetch(`${address}/v1/jobs/${id}/cancel`, { method: 'POST' });
}

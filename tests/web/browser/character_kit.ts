/** What the tests of characters share: the page of a finished one with its corrections open, and what it sends. */

import type { Page, Request } from 'playwright-core';
import { expect, inject } from 'vitest';
import { LONG } from './page';

export const again = (page: Page) => page.getByRole('button', { name: 'Make it again' });
export const isOrder = (request: Request): boolean => request.method() === 'POST' && request.url().endsWith('/v1/jobs');
export const isRevision = (request: Request): boolean =>
  request.method() === 'POST' && request.url().endsWith('/revisions');

/** Opens the corrections of a character on its page, once it is made. */
export async function openCorrections(page: Page): Promise<void> {
  await page.getByRole('region', { name: 'Result' }).waitFor({ timeout: LONG });
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
  await fetch(`${inject('address')}/v1/jobs/${id}/cancel`, { method: 'POST' });
}

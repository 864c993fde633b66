/** What a browser itself says went wrong while a test ran: errors of scripts, and answers that it calls failures. */

import type { Page } from 'playwright-core';

/** What the page complained of that was watched last, without what was expected. */
export const complaints: string[] = [];

let watched: Page | null = null;
let expected: RegExp[] = [];

/** Listen to a page from now on, and to no other. */
export function watch(page: Page): void {
  watched = page;
  expected = [];
  complaints.length = 0;
  const hear = (text: string): void => {
    if (page === watched && !expected.some((like) => like.test(text))) complaints.push(text);
  };
  page.on('pageerror', (error) => hear(error.message));
  page.on('console', (message) => message.type() === 'error' && hear(message.text()));
}

/**
 * The test brings this about itself: it is no complaint. A browser says it when it likes, before or after what the page shows
 * of it, so this holds for what was said already and for what will be.
 */
export function expectComplaint(like: RegExp): void {
  expected.push(like);
  complaints.splice(0, Infinity, ...complaints.filter((text) => !like.test(text)));
}

/** An answer of this status, of which Chromium says that something failed to load. */
export const answered = (status: number): RegExp => new RegExp(`^Failed to load resource: .* status of ${status} `);

/** A request that came nowhere. */
export const unanswered = /^Failed to load resource: net::ERR_/;

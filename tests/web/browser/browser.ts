/** The browser of the tests: a real Chromium. */

import { type Browser, chromium } from 'playwright-core';
import { shake } from './shaken';

const flags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

/** Milliseconds that a page is waited for, whatever for; as long as what is polled (`vitest.config.ts`). */
export const PATIENCE = 300_000;

/** Starts one. Each of its pages is waited for with patience, and shaken where that is asked for. */
export async function launch(more: string[] = []): Promise<Browser> {
  const executablePath = process.env.GALATEA_CHROMIUM ?? '/usr/bin/chromium';
  const browser = await chromium.launch({ executablePath, args: [...flags, ...more] });
  const newPage = browser.newPage.bind(browser);
  browser.newPage = async (options) => {
    const page = await newPage(options);
    page.setDefaultTimeout(PATIENCE);
    await shake(page);
    return page;
  };
  return browser;
}

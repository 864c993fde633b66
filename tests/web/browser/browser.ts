/** The browser of the tests: a real Chromium. */

import { type Browser, chromium } from 'playwright-core';

const flags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

export const launch = (more: string[] = []): Promise<Browser> =>
  chromium.launch({ executablePath: process.env.GALATEA_CHROMIUM ?? '/usr/bin/chromium', args: [...flags, ...more] });

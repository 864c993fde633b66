/** The page of the viewer's tests (`viewer_build`), served from the service's own address. */

import { existsSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { inject } from 'vitest';
import { address } from './own_service';
import { PATH } from './viewer_build';

const folder = inject('viewerPage');

/** Show a job's character on it. */
export async function openViewer(page: Page, job: string): Promise<void> {
  await page.route(`${address}${PATH}**`, async (route) => {
    const path = join(folder, new URL(route.request().url()).pathname.slice(PATH.length) || 'index.html');
    await (existsSync(path) ? route.fulfill({ path }) : route.fulfill({ status: 404 }));
  });
  await page.goto(`${address}${PATH}#${job}`);
}

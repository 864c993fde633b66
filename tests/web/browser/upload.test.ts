/** Resumable uploads as browsers make them: the real tus-js-client in a real page, over a line that is cut. */

import './nobody_works';
import { connect, createServer, type Server, type Socket } from 'node:net';
import { join, resolve } from 'node:path';
import type { Browser, CDPSession, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it, vi } from 'vitest';
import type { Upload } from '../../../web/node_modules/tus-js-client';
import { launch, PATIENCE } from './browser';
import { address } from './own_service';
import { open } from './page';

const client = join(resolve(import.meta.dirname, '../../..'), 'web/node_modules/tus-js-client/dist/tus.min.js');
const BYTES = 24_000_000;
const BYTES_PER_SECOND = 6_000_000;

declare global {
  interface Window {
    tus: typeof import('../../../web/node_modules/tus-js-client');
    upload: Upload;
    media: File;
    sent: number;
    outcome: string;
  }
}

/** A line to the service that can be cut. */
class Line {
  address = '';
  private readonly server: Server;
  private readonly sockets = new Set<Socket>();

  constructor() {
    const { hostname, port } = new URL(address);
    this.server = createServer((near) => {
      const far = connect(Number(port), hostname);
      for (const [from, to] of [
        [near, far],
        [far, near],
      ] as const) {
        this.sockets.add(from);
        from.on('error', () => to.destroy()).on('close', () => to.destroy());
        from.pipe(to);
      }
    });
  }

  async open(): Promise<void> {
    await new Promise<void>((listening) => this.server.listen(0, '127.0.0.1', listening));
    const address = this.server.address();
    if (address && typeof address === 'object') this.address = `http://127.0.0.1:${address.port}`;
  }

  cut(): void {
    for (const socket of this.sockets) socket.resetAndDestroy();
    this.sockets.clear();
  }

  close(): void {
    this.server.close();
    this.cut();
  }
}

let browser: Browser;
let cable: Line;
beforeAll(async () => {
  browser = await launch();
  cable = new Line();
  await cable.open();
});
afterAll(() => {
  cable.close();
  return browser.close();
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
});

/** The page with the client in it, over a slow line; what the client asked for is noted. */
async function prepared(): Promise<{ page: Page; line: CDPSession; requests: string[] }> {
  const page = await open(browser, '', { bypassCSP: true });
  await page.goto(cable.address);
  const requests: string[] = [];
  page.on('request', (request) => {
    if (!request.url().includes('/v1/uploads')) return;
    requests.push(`${request.method()} ${request.headers()['upload-offset'] ?? ''}`.trim());
  });
  const line = await page.context().newCDPSession(page);
  await line.send('Network.enable');
  await network(line, false);
  await prepare(page);
  return { page, line, requests };
}

const network = (line: CDPSession, offline: boolean): Promise<unknown> =>
  line.send('Network.emulateNetworkConditions', {
    offline,
    latency: 0,
    downloadThroughput: -1,
    uploadThroughput: BYTES_PER_SECOND,
  });

/** Load the client and make the file: the same one each time, begun like an MP4. */
async function prepare(page: Page): Promise<void> {
  await page.addScriptTag({ path: client });
  await page.evaluate((length) => {
    const words = new Uint32Array(length / 4);
    let word = 2463534242;
    for (let i = 0; i < words.length; i++) {
      word ^= word << 13;
      word ^= word >>> 17;
      word ^= word << 5;
      words[i] = word;
    }
    const head = '\0\0\0\x18ftypisom\0\0\x02\0isomiso2';
    new Uint8Array(words.buffer).set([...head].map((letter) => letter.charCodeAt(0)));
    window.media = new File([words], 'a performance.mp4', { type: 'video/mp4', lastModified: 1 });
    window.upload = new window.tus.Upload(window.media, {
      endpoint: '/v1/uploads',
      metadata: { filename: window.media.name, filetype: window.media.type },
      retryDelays: [200, 500, 1000],
      removeFingerprintOnSuccess: true,
      onProgress: (sent) => {
        window.sent = sent;
      },
      onSuccess: () => {
        window.outcome = 'success';
      },
      onError: (error) => {
        window.outcome = `error: ${error.message}`;
      },
    });
    window.sent = 0;
    window.outcome = '';
  }, BYTES);
}

const start = (page: Page): Promise<void> => page.evaluate(() => window.upload.start());
const untilSent = (page: Page, bytes: number): Promise<unknown> => page.waitForFunction((n) => window.sent > n, bytes);
const untilOutcome = (page: Page, outcome: string): Promise<unknown> =>
  page.waitForFunction((prefix) => window.outcome.startsWith(prefix), outcome);

/** Whether the service has, under the upload's id, the very file that the page has. */
async function arrived(page: Page): Promise<void> {
  const [id, sha256] = await page.evaluate(async () => {
    const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', await window.media.arrayBuffer()));
    const hex = Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
    return [window.upload.url?.split('/').at(-1), hex] as const;
  });
  const file = (await (await fetch(`${address}/v1/files/${id}`)).json()) as Record<string, unknown>;
  expect(file).toMatchObject({ name: 'a performance.mp4', content_type: 'video/mp4', size: BYTES, sha256 });
}

/** Where the pieces began that were sent after the first. */
const resumedAt = (requests: string[]): number[] =>
  requests.filter((request) => request.startsWith('PATCH')).map((request) => Number(request.split(' ')[1])).slice(1);

describe('a resumable upload', () => {
  it('goes on where it was after a pause and after the line was cut twice', async () => {
    const { page, line, requests } = await prepared();
    await start(page);
    await untilSent(page, BYTES * 0.2);
    await page.evaluate(() => window.upload.abort());
    await start(page);
    await untilSent(page, BYTES * 0.4);
    // Chromium sends the whole piece once more, which is refused with 409; then the client asks where to go on.
    cable.cut();
    await vi.waitFor(() => expect(resumedAt(requests)).toHaveLength(2), PATIENCE);
    await page.evaluate(() => {
      window.sent = 0;
    });
    await untilSent(page, BYTES * 0.5);
    await network(line, true);
    cable.cut();
    await untilOutcome(page, 'error'); // it knows that it is offline, and waits to be told to go on
    await network(line, false);
    await start(page);
    await untilOutcome(page, 'success');
    await arrived(page);
    expect(requests.filter((request) => request === 'POST')).toHaveLength(1);
    const offsets = [0, ...resumedAt(requests)];
    expect(offsets.length).toBeGreaterThanOrEqual(4);
    for (let i = 1; i < offsets.length; i++) expect(offsets[i]).toBeGreaterThan(offsets[i - 1] ?? 0);
  });

  it('goes on where it was after the page was loaded anew', async () => {
    const { page, requests } = await prepared();
    await start(page);
    await untilSent(page, BYTES * 0.3);
    await page.reload();
    await prepare(page);
    const earlier = await page.evaluate(async () => {
      const found = await window.upload.findPreviousUploads();
      if (found[0] !== undefined) window.upload.resumeFromPreviousUpload(found[0]);
      return found.length;
    });
    expect(earlier).toBe(1);
    await start(page);
    await untilOutcome(page, 'success');
    await arrived(page);
    expect(requests.filter((request) => request === 'POST')).toHaveLength(1);
    expect(resumedAt(requests)[0]).toBeGreaterThan(0);
    await expect.poll(() => page.evaluate(() => window.upload.findPreviousUploads())).toEqual([]);
  });

  it('learns why a file is refused', async () => {
    const { page } = await prepared();
    const code = await page.evaluate(
      () =>
        new Promise<string>((done) => {
          const file = new File(['<html>'.repeat(2000)], 'page.mp4', { type: 'video/mp4' });
          new window.tus.Upload(file, {
            endpoint: '/v1/uploads',
            onSuccess: () => done('success'),
            onError: (error) => done('originalResponse' in error ? (error.originalResponse?.getBody() ?? '') : ''),
          }).start();
        }),
    );
    expect(JSON.parse(code)).toMatchObject({ status: 415, code: 'media_type_unsupported' });
  });
});

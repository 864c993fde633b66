/** What the browser tests share: a browser, real media, and a job that was ordered over the API. */

import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { type Browser, chromium, type Page } from 'playwright-core';
import { expect, inject } from 'vitest';
import { watch } from './complaints';

const root = resolve(import.meta.dirname, '../../..');
const python = join(root, '.venv/bin/python');

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

/** What a few lines of Python print, in the environment of the service. */
export const inPython = (lines: string, ...given: string[]): string =>
  execFileSync(python, ['-c', lines, ...given], { cwd: root }).toString().trim();

/** A portrait that comes with matplotlib. */
export const portrait = inPython(
  'import matplotlib, pathlib; print(pathlib.Path(matplotlib.__file__).parent / "mpl-data/sample_data/grace_hopper.jpg")',
);

/** A picture without a face, from the same place. */
export const faceless = join(portrait, '../Minduka_Present_Blue_Pack.png');

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
  await page.goto(`${inject('address')}/${hash}`);
  return page;
}

/** Asks the service as any other client would; JSON. */
export const ask = async <T,>(path: string): Promise<T> => (await (await fetch(inject('address') + path)).json()) as T;

/** A job's id, from the address of its page. */
export const jobOf = (page: Page): string => page.url().split('/').at(-1) ?? '';

/** Milliseconds: a job's time on a machine that has other work as well. */
export const LONG = 400_000;

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
  submit('portrait', { image: picture(image), ...(driver !== null && { driver }) }, options);

/**
 * The page of a job that takes a while, opened while the job waits or has just begun: what it shows on the way can be
 * watched, however fast the machine is. It waits for as many like it as are to be `ahead`.
 */
export async function openRunning(browser: Browser, ahead = 0): Promise<Page> {
  const page = await open(browser);
  await page.getByRole('radio').first().waitFor({ state: 'attached' });
  const driver = lengthyPerformance();
  for (let one = 0; one < ahead; one++) await order(portrait, driver);
  const job = await order(portrait, driver);
  await page.evaluate((id) => (location.hash = `#/jobs/${id}`), job);
  return page;
}

/** A driver of twenty seconds: a performance of the project's own, five times over. */
function lengthyPerformance(): File {
  const path = join(mkdtempSync(join(tmpdir(), 'galatea-')), 'lengthy.mp4');
  inPython(
    `
import sys
import av
from engine.performances.catalogue import video
with av.open(str(video("happy"))) as source, av.open(sys.argv[1], "w") as target:
    stream = target.add_stream_from_template(source.streams.video[0])
    packets = [packet for packet in source.demux(video=0) if packet.dts is not None]
    length = source.streams.video[0].duration
    for packet in packets:
        packet.stream = stream
    for _ in range(5):
        target.mux(packets)
        for packet in packets:
            packet.pts += length
            packet.dts += length
`,
    path,
  );
  return picture(path);
}

/** Order a character likewise. */
export const orderCharacter = (photo: string, options: object = {}): Promise<string> =>
  submit('character', { photo: picture(photo) }, options);

const picture = (path: string): File => new File([readFileSync(path)], path.split('/').at(-1) ?? '');

async function submit(kind: string, inputs: Record<string, File | string>, options: object): Promise<string> {
  const body = new FormData();
  body.append('kind', kind);
  for (const [name, value] of Object.entries(inputs)) body.append(name, value);
  body.append('options', JSON.stringify(options));
  const response = await fetch(`${inject('address')}/v1/jobs`, { method: 'POST', body });
  expect(response.status, await response.clone().text()).toBe(202);
  return ((await response.json()) as { id: string }).id;
}

/** Writes a picture of the project's own that shows somebody whole, 450 by 600 pixels. */
export const samplePerson = (path: string): string =>
  inPython(
    'import sys; from PIL import Image; from engine.character.sample import sample_picture as s; ' +
      'Image.fromarray(s()).save(sys.argv[1])',
    path,
  );

const mediaFolder = process.env.GALATEA_TEST_DATA ?? resolve(root, '../shared/data');

/** A file of the shared test media, which are kept outside the project; null where they are absent (never in CI). */
export function media(name: string): string | null {
  const path = join(mediaFolder, name);
  if (existsSync(path)) return path;
  if (process.env.CI === 'true') throw new Error(`test media not found: ${path} (set GALATEA_TEST_DATA)`);
  return null;
}

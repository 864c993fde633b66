/** Builds the page of the viewer's tests, and serves it from the service's own address. */

import { resolve } from 'node:path';
import type { Page } from 'playwright-core';
import { build } from 'vite';
import { address } from './own_service';

const web = resolve(import.meta.dirname, '../../../web');
const MOUNT = resolve(import.meta.dirname, 'viewer.mount.tsx');
const PATH = '/viewer-test/';

export type Files = Map<string, { body: Buffer; type: string }>;

export async function buildViewerPage(): Promise<Files> {
  const built = await build({
    configFile: false,
    root: web,
    base: PATH,
    publicDir: false,
    logLevel: 'warn',
    resolve: { alias: { '@web': resolve(web, 'src') } },
    plugins: [
      {
        name: 'what is installed for the page',
        enforce: 'pre',
        resolveId(source, importer) {
          return importer === MOUNT && /^(preact|three)\b/.test(source)
            ? this.resolve(source, resolve(web, 'src/main.tsx'), { skipSelf: true })
            : null;
        },
      },
    ],
    build: {
      write: false,
      target: 'es2022',
      minify: false,
      modulePreload: { polyfill: false },
      rollupOptions: {
        input: MOUNT,
        output: { entryFileNames: 'mount.js', assetFileNames: '[name][extname]' },
      },
    },
  });
  if (!('output' in built)) throw new Error('nothing was built');
  const files: Files = new Map();
  const styles: string[] = [];
  for (const part of built.output) {
    const style = part.fileName.endsWith('.css');
    if (style) styles.push(part.fileName);
    const body = Buffer.from(part.type === 'chunk' ? part.code : part.source);
    files.set(part.fileName, { body, type: style ? 'text/css' : 'text/javascript' });
  }
  const links = styles.map((name) => `<link rel="stylesheet" href="${PATH}${name}">`).join('');
  const html = `<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
    <title>Viewer</title>${links}<script type="module" src="${PATH}mount.js"></script><main id="app"></main></html>`;
  files.set('', { body: Buffer.from(html), type: 'text/html' });
  return files;
}

/** Show a job's character on it. */
export async function openViewer(page: Page, files: Files, job: string): Promise<void> {
  await page.route(`${address}${PATH}**`, async (route) => {
    const name = new URL(route.request().url()).pathname.slice(PATH.length);
    const file = files.get(name);
    await (file ? route.fulfill({ body: file.body, contentType: file.type }) : route.fulfill({ status: 404 }));
  });
  await page.goto(`${address}${PATH}#${job}`);
}

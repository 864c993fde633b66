/** Builds the page of the viewer's tests, once a run. */

import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import type { TestProject } from 'vitest/node';

declare module 'vitest' {
  export interface ProvidedContext {
    /** The folder that the page of the viewer's tests is built in. */
    viewerPage: string;
  }
}

/** Where on the service's address it is served. */
export const PATH = '/viewer-test/';

const web = resolve(import.meta.dirname, '../../../web');
const MOUNT = resolve(import.meta.dirname, 'viewer.mount.tsx');

export default async function setup(project: TestProject): Promise<() => void> {
  const folder = mkdtempSync(join(tmpdir(), 'galatea-viewer-page-'));
  const write = (name: string, body: string | Uint8Array): void => {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), body);
  };
  const { build } = await import('vite'); // not what its tests need
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
  const styles: string[] = [];
  for (const part of built.output) {
    if (part.fileName.endsWith('.css')) styles.push(part.fileName);
    write(part.fileName, part.type === 'chunk' ? part.code : part.source);
  }
  const links = styles.map((name) => `<link rel="stylesheet" href="${PATH}${name}">`).join('');
  write(
    'index.html',
    `<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
    <title>Viewer</title>${links}<script type="module" src="${PATH}mount.js"></script><main id="app"></main></html>`,
  );
  project.provide('viewerPage', folder);
  return () => rmSync(folder, { recursive: true });
}

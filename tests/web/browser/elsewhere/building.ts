/** Pages of other people's programs with an avatar in them, built from what is installed and served from a folder. */

import { createReadStream, existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { dirname, join, resolve } from 'node:path';

const web = resolve(import.meta.dirname, '../../../../web');
const MIME: Record<string, string> = { html: 'text/html', js: 'text/javascript' };

/** Builds the pages `NAME.html` out of `NAME.ts`, which stand beside this file, into a folder. */
export async function buildPages(folder: string, names: readonly string[]): Promise<void> {
  const { build } = await import('vite'); // not what every test needs
  const write = (name: string, body: string | Uint8Array): void => {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), body);
  };
  const built = await build({
    configFile: false,
    root: web,
    base: '/',
    publicDir: false,
    logLevel: 'error',
    plugins: [
      {
        name: 'what is installed for the page',
        enforce: 'pre',
        resolveId(source, importer) {
          return importer?.startsWith(`${import.meta.dirname}/`) && /^[@a-z]/.test(source)
            ? this.resolve(source, resolve(web, 'src/main.tsx'), { skipSelf: true })
            : null;
        },
      },
    ],
    build: {
      write: false,
      target: 'es2022',
      minify: false,
      modulePreload: false,
      rollupOptions: {
        input: Object.fromEntries(names.map((name) => [name, join(import.meta.dirname, `${name}.ts`)])),
        output: { entryFileNames: '[name].js' },
      },
    },
  });
  if (!('output' in built)) throw new Error('nothing was built');
  for (const part of built.output) write(part.fileName, part.type === 'chunk' ? part.code : part.source);
  for (const name of names) {
    write(
      `${name}.html`,
      `<!doctype html><html lang="en"><meta charset="utf-8"><title>${name}</title><link rel="icon" href="data:,">
      <style>body { margin: 0 } #avatar, model-viewer { width: 150px; height: 200px }</style>
      <script type="module" src="/${name}.js"></script><div id="avatar"></div></html>`,
    );
  }
}

/** Serves a folder, and where. */
export async function serveFolder(folder: string): Promise<{ server: Server; address: string }> {
  const server = createServer((request, response) => {
    const path = join(folder, new URL(request.url ?? '/', 'http://localhost').pathname);
    if (!path.startsWith(folder) || !existsSync(path)) return void response.writeHead(404).end();
    response.writeHead(200, { 'content-type': MIME[path.split('.').at(-1)!] ?? 'application/octet-stream' });
    createReadStream(path).pipe(response);
  });
  await new Promise<void>((ready) => server.listen(0, '127.0.0.1', ready));
  return { server, address: `http://127.0.0.1:${(server.address() as AddressInfo).port}` };
}

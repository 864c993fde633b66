/** Writes each text file of the built page a second and a third time, as brotli and gzip: the service sends what fits. */

import { readdirSync, readFileSync, statSync, utimesSync, writeFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';

const texts = new Set(['.css', '.html', '.js', '.json', '.svg']);
const least = 1000;
const encodings = {
  br: (data) => brotliCompressSync(data, { params: { [constants.BROTLI_PARAM_SIZE_HINT]: data.length } }),
  gz: (data) => gzipSync(data, { level: 9 }),
};

const folder = process.argv[2] ?? 'dist';
for (const entry of readdirSync(folder, { recursive: true, withFileTypes: true })) {
  const path = join(entry.parentPath ?? entry.path, entry.name);
  if (!entry.isFile() || !texts.has(extname(path))) continue;
  const { size, atime, mtime } = statSync(path);
  if (size < least) continue;
  for (const [ending, compress] of Object.entries(encodings)) {
    const compressed = statSync(`${path}.${ending}`, { throwIfNoEntry: false });
    if (compressed && compressed.mtimeMs >= mtime.getTime()) continue;
    writeFileSync(`${path}.${ending}`, compress(readFileSync(path)));
    utimesSync(`${path}.${ending}`, atime, mtime);
  }
}

/** What is published of the player: one small file that stands alone. */

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { gzipSync } from 'node:zlib';
import { expect, it } from 'vitest';
import { parseTriggers } from '../../../../web/reactive/src/profile';

const folder = resolve(import.meta.dirname, '../../../../web/reactive');

it('is one script under 15 kB', () => {
  const script = readFileSync(`${folder}/dist/reactive-portrait.js`); // make setup builds it
  expect(gzipSync(script).length).toBeLessThan(15_000);
  expect(/\bimport\s*[{"'(]/.test(script.toString())).toBe(false);
});

it('is packed with its types, its schema and how to use it', () => {
  const [packed] = JSON.parse(execFileSync('npm', ['pack', '--dry-run', '--json'], { cwd: folder }).toString());
  const files = packed.files.map(({ path }: { path: string }) => path);
  expect(packed.name).toBe('@galatea/reactive-portrait');
  expect(files).toEqual(
    expect.arrayContaining(['README.md', 'dist/reactive-portrait.js', 'dist/types/index.d.ts', 'profile.schema.json']),
  );
  expect(files.filter((path: string) => path.startsWith('src/') || path.endsWith('config.ts'))).toEqual([]);
  const { exports, types } = JSON.parse(readFileSync(`${folder}/package.json`, 'utf8'));
  for (const path of [types, exports['.'].types, exports['.'].default]) expect(files).toContain(path.replace('./', ''));
}, 60_000);

it('takes triggers as a page writes them', () => {
  expect(parseTriggers('hover:happy  click:very-happy key(Enter):nod key(:):wink view:surprise')).toEqual([
    { on: 'hover', state: 'happy' },
    { on: 'click', state: 'very-happy' },
    { on: 'key', key: 'Enter', state: 'nod' },
    { on: 'key', key: ':', state: 'wink' },
    { on: 'view', state: 'surprise' },
  ]);
  expect(parseTriggers('none')).toEqual([]);
  expect(parseTriggers('')).toEqual([]);
});

/** What people read holds words, no names of the program: a name that is changed everywhere must not change them. */

import { readdirSync, readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { expect, it } from 'vitest';

const source = resolve(import.meta.dirname, '../../../../web/src');
const WORDS = /(^|\/)words\/en(\.ts|\/\w+\.ts)$/;
const TEXTS = /'(?:[^'\\\n]|\\.)*'|`(?:[^`\\]|\\.)*`|"(?:[^"\\\n]|\\.)*"/g;
/** Names that are written so. */
const PROPER = new Set(['OpenAPI', 'glTF', 'WebP', 'WebM', 'WebGL', 'WebXR', 'iPhone', 'iPad', 'GitHub', 'JavaScript', 'model-viewer']);

const files = readdirSync(source, { recursive: true, encoding: 'utf8' })
  .map((name) => name.replaceAll('\\', '/'))
  .filter((name) => WORDS.test(name));

it('looks at the words of the page, of its kinds and of the viewer', () => {
  const folders = ['language', 'kinds/character', 'kinds/portrait', 'viewer'];
  expect(files).toEqual(expect.arrayContaining(folders.map((folder) => `${folder}/words/en.ts`)));
});

it('has no section that one kind alone uses among the words that all share', () => {
  const shared = files.filter((name) => name.startsWith('language/'));
  const used = new Set(shared.flatMap((name) => [...readFileSync(resolve(source, name), 'utf8').matchAll(/^ {2}(\w+): \{$/gm)].map(([, section]) => section!)));
  const sources = readdirSync(source, { recursive: true, encoding: 'utf8' }).filter((name) => /\.tsx?$/.test(name) && !shared.includes(name));
  const rooms = (section: string): string[] =>
    sources
      .filter((name) => new RegExp(`strings\\.${section}\\b`).test(readFileSync(resolve(source, name), 'utf8')))
      .map((name) => /^kinds\/(?!generic)\w+/.exec(name)?.[0] ?? 'all');
  const ofOne = [...used].filter((section) => new Set(rooms(section)).size === 1 && !rooms(section).includes('all'));
  expect(ofOne).toEqual([]);
});

it.each(files)('has no name of the program among the words of %s', (name) => {
  const written = readFileSync(resolve(source, name), 'utf8').replace(/^import .*$|\/\*[\s\S]*?\*\/|\/\/.*$/gm, '');
  const names = [...written.matchAll(TEXTS)]
    .flatMap(([text]) => text.replace(/\$\{[^}]*\}/g, ' ').match(/\b[A-Za-z]*[a-z][A-Z][A-Za-z]*\b/g) ?? [])
    .filter((word) => !PROPER.has(word));
  expect(names).toEqual([]);
});

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

it('looks at the words of the page and of its kinds', () => {
  expect(files).toEqual(expect.arrayContaining(['language/words/en.ts', 'kinds/character/words/en.ts']));
});

it.each(files)('has no name of the program among the words of %s', (name) => {
  const written = readFileSync(resolve(source, name), 'utf8').replace(/^import .*$|\/\*[\s\S]*?\*\/|\/\/.*$/gm, '');
  const names = [...written.matchAll(TEXTS)]
    .flatMap(([text]) => text.replace(/\$\{[^}]*\}/g, ' ').match(/\b[A-Za-z]*[a-z][A-Z][A-Za-z]*\b/g) ?? [])
    .filter((word) => !PROPER.has(word));
  expect(names).toEqual([]);
});

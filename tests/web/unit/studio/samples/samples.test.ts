import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { samples as figures } from '@web/kinds/character/samples';
import { samples as portraits } from '@web/kinds/portrait/samples';
import { fileName, sampleUrl, smallUrl } from '@web/studio/samples/sample_pictures';
import { describe, expect, it } from 'vitest';

const samples = [...portraits, ...figures];
const root = resolve(import.meta.dirname, '../../../../..');
const folder = join(root, 'web/public/samples');
const files = readdirSync(folder);
const licences = readFileSync(join(root, 'docs/licences.md'), 'utf8');

describe.each(samples)('the sample $name', (sample) => {
  it('is there, large and small, with its source', () => {
    for (const url of [sampleUrl(sample), smallUrl(sample)]) {
      expect(files).toContain(url.replace('/samples/', ''));
    }
    expect(licences).toContain(`\`${sample.name}.jpg\``);
  });
});

it('is called as people write it', () => {
  expect(fileName(portraits[0]!)).toBe('Grace Hopper.jpg');
  expect(fileName(figures[0]!)).toBe('Woman in red.jpg');
});

it('has no file but what the page shows, and none that is large', () => {
  for (const file of files) {
    const stem = file.replace(/\.\w+$/, '');
    const known = samples.some(({ name }) => stem === name || stem.startsWith(`${name}-`));
    expect(known, file).toBe(true);
    expect(statSync(join(folder, file)).size, file).toBeLessThan(file.endsWith('.jpg') ? 200_000 : 300_000);
  }
});

import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileName, figureSamples, portraitSamples, sampleUrl, smallUrl } from '@web/studio/sample_pictures';
import { describe, expect, it } from 'vitest';

const root = resolve(import.meta.dirname, '../../..');
const folder = join(root, 'web/public/samples');
const files = readdirSync(folder);
const licences = readFileSync(join(root, 'docs/licences.md'), 'utf8');

describe.each([...portraitSamples, ...figureSamples])('the sample %s', (name) => {
  it('is there, large and small, with its source', () => {
    for (const url of [sampleUrl(name), smallUrl(name)]) {
      expect(files).toContain(url.replace('/samples/', ''));
    }
    expect(licences).toContain(`\`${name}.jpg\``);
  });
});

it('is called as people write it', () => {
  expect(fileName('grace-hopper')).toBe('Grace Hopper.jpg');
  expect(fileName('woman-in-red')).toBe('Woman in red.jpg');
});

it('has no file but what the page shows, and none that is large', () => {
  for (const file of files) {
    const stem = file.replace(/\.\w+$/, '');
    const known = [...portraitSamples, ...figureSamples].some((name) => stem === name || stem.startsWith(`${name}-`));
    expect(known, file).toBe(true);
    expect(statSync(join(folder, file)).size, file).toBeLessThan(file.endsWith('.jpg') ? 200_000 : 300_000);
  }
});

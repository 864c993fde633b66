import type { Job } from '@web/api';
import { ofDriver } from '@web/performances/drivers';
import { kinds } from '@web/kinds';
import { keptName } from '@web/studio/kept_name';
import { differences } from '@web/works/differences';
import { workName } from '@web/works/names';
import { describe, expect, it } from 'vitest';
import { aJob } from '../job';

const changes = (job: Job, before: Job) => differences(job, before, kinds.of(job.kind));

describe('what was changed from one version to the next', () => {
  const before = aJob({ options: { strength: 1, follow: ['eyes'], size: null } });

  it('is said in words, with a value where one word tells it', () => {
    const now = aJob({ options: { strength: 1.5, loop: true }, inputs: { ...before.inputs, driver: 'aunt-mary/happy' } });
    expect(changes(now, before)).toEqual(['performance (Aunt mary: happy)', 'strength (150%)', 'what moves', 'loop']);
  });

  it('is nothing where nothing was changed, or the same was said otherwise', () => {
    expect(changes(aJob({ options: { follow: ['eyes'], strength: 1 } }), before)).toEqual([]);
  });

  it('names a motion, and once what two options are about', () => {
    const walk = aJob({ kind: 'character', inputs: { photo: 'x' }, options: {} });
    const bow = aJob({ ...walk, options: { motion: 'bow', mask: 'y', mask_strokes: [1], unheard_of: 1 } });
    expect(changes(bow, walk)).toEqual(['motion (Bow)', 'mask', 'unheard of']);
  });
});

describe('names', () => {
  it('of a work is its title, or that of its picture', () => {
    const job = aJob({ metadata: { portrait: 'IMG 7' } });
    expect([workName(job, kinds.of(job.kind)), workName({ ...job, title: 'Aunt Mary' }, kinds.of(job.kind))]).toEqual(['IMG 7', 'Aunt Mary']);
  });

  it('that are typed become names of what is kept, without a letter lost in silence', () => {
    expect(['Aunt  Mary ', 'tante_möwe', 'a/b'].map(keptName)).toEqual(['aunt-mary', 'tante_möwe', 'a/b']);
  });

  it('tell whose a moment is', () => {
    expect(['mary', 'mary/happy', 'mary-2', 'mary-2/happy'].map((name) => ofDriver(name, 'mary'))).toEqual([true, true, false, false]);
  });
});

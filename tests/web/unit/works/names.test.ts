import { driverName, performanceUrl } from '@web/performances/drivers';
import type { Job } from '@web/api';
import { kinds } from '@web/kinds';
import * as names from '@web/works/names';
import { describe, expect, it } from 'vitest';
import { aJob } from '../job';

const pictureName = (job: Job) => names.pictureName(job, kinds.of(job.kind));
const pictureUrl = (job: Job) => names.pictureUrl(job, kinds.of(job.kind));
const performanceName = (job: Job) => kinds.of(job.kind).performance(job);

const file = '0198c1d2-7b1a-7c3e-9c6d-000000000002';
const drivenBy = (driver: string) => aJob({ inputs: { image: 'x', driver } });

describe('what a job is called', () => {
  it('goes by what the client said', () => {
    const job = aJob({ metadata: { portrait: 'Aunt Mary', performance: 'birthday' } });
    expect([pictureName(job), performanceName(job)]).toEqual(['Aunt Mary', 'birthday']);
  });

  it('of a character goes by its picture, and by what it does', () => {
    const job = (differs: object) => aJob({ kind: 'character', inputs: { photo: file }, ...differs });
    expect([pictureName(job({ metadata: { photo: 'Anna' } })), pictureName(job({}))]).toEqual(['Anna', 'Character']);
    expect(pictureUrl(job({}))).toBe(`/v1/files/${file}/content`);
    expect([performanceName(job({})), performanceName(job({ options: { motion: 'sit' } }))]).toEqual(['Walk', 'Sit down']);
    const moved = { inputs: { photo: file, motion: file }, options: { motion: 'walk' } };
    expect(performanceName(job(moved))).toBeNull();
    expect(performanceName(job({ ...moved, metadata: { motion: 'Cartwheel' } }))).toBe('Cartwheel');
  });

  it('does without it', () => {
    expect(pictureName(aJob({ metadata: { portrait: 7 } }))).toBe('Portrait');
    expect(performanceName(drivenBy('happy'))).toBe('Happy');
    expect(performanceName(drivenBy(file))).toBeNull();
  });
});

describe('what a driver is called', () => {
  it('goes by the file', () => {
    expect(driverName('Ängste & Freuden (3)', [])).toBe('ngste-freuden-3');
    expect(driverName('___', [])).toBe('driver');
    expect(driverName('x'.repeat(99), [])).toHaveLength(50);
  });

  it('is another than those that are taken', () => {
    expect(driverName('me', ['happy'])).toBe('me');
    expect(driverName('me', ['me', 'me-2'])).toBe('me-3');
  });
});

describe('where the performance plays from', () => {
  it('knows files from names', () => {
    expect(performanceUrl(drivenBy(file))).toBe(`/v1/files/${file}/content`);
    expect(performanceUrl(drivenBy('happy'))).toBe('/v1/drivers/happy/video');
  });

  it('plays the whole video of a moment, whose part the trim tells', () => {
    expect(performanceUrl(drivenBy('me/happy-2'))).toBe('/v1/drivers/me/video');
    expect(performanceName(drivenBy('me/happy-2'))).toBe('Me: happy 2');
  });

  it('loads nothing from elsewhere', () => {
    expect(performanceUrl(drivenBy('https://example.org/a.mp4'))).toBeNull();
    expect(performanceUrl(drivenBy('auto'))).toBeNull();
  });

  it('knows the one that the job has chosen', () => {
    expect(performanceUrl(drivenBy('auto'), 'nod-strong')).toBe('/v1/drivers/nod-strong/video');
    expect(performanceUrl(drivenBy('happy'), 'nod-strong')).toBe('/v1/drivers/happy/video');
  });
});

import { performanceName, performanceUrl, portraitName } from '@web/names';
import { describe, expect, it } from 'vitest';
import { aJob } from './job';

const file = '0198c1d2-7b1a-7c3e-9c6d-000000000002';
const drivenBy = (driver: string) => aJob({ inputs: { image: 'x', driver } });

describe('what a job is called', () => {
  it('goes by what the client said', () => {
    const job = aJob({ metadata: { portrait: 'Aunt Mary', performance: 'birthday' } });
    expect([portraitName(job), performanceName(job)]).toEqual(['Aunt Mary', 'birthday']);
  });

  it('does without it', () => {
    expect(portraitName(aJob({ metadata: { portrait: 7 } }))).toBe('Portrait');
    expect(performanceName(drivenBy('happy'))).toBe('Happy');
    expect(performanceName(drivenBy(file))).toBeNull();
  });
});

describe('where the performance plays from', () => {
  it('knows files from names', () => {
    expect(performanceUrl(drivenBy(file))).toBe(`/v1/files/${file}/content`);
    expect(performanceUrl(drivenBy('happy'))).toBe('/v1/drivers/happy/video');
  });

  it('loads nothing from elsewhere', () => {
    expect(performanceUrl(drivenBy('https://example.org/a.mp4'))).toBeNull();
    expect(performanceUrl(drivenBy('auto'))).toBeNull();
  });
});

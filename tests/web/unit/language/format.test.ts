import { ago, clock, duration, percent, size, stem } from '@web/language/format';
import { describe, expect, it } from 'vitest';

describe('numbers in words', () => {
  it('tells the position in a video, finely in a short one', () => {
    expect([0, 7.94, 83.2].map((seconds) => clock(seconds, 90))).toEqual(['0:00', '0:07', '1:23']);
    expect([0, 7.94, NaN].map((seconds) => clock(seconds, 8))).toEqual(['0.0', '7.9', '0.0']);
    expect(clock(0, NaN)).toBe('0.0'); // not loaded yet
  });

  it('never promises less time than is left, and no zero', () => {
    expect([0, 3.2, 59.9, 90, 3600, 4800].map(duration)).toEqual([
      '1 sec',
      '4 sec',
      '1 min',
      '2 min',
      '1 hr',
      '1 hr 20 min',
    ]);
  });

  it('says 100% only when it is done', () => {
    expect([0, 0.28, 0.29, 0.999, 1, 1.2].map(percent)).toEqual(['0%', '28%', '29%', '99%', '100%', '100%']);
  });

  it('keeps sizes short, without a jump between units', () => {
    expect([999, 1000, 999_499, 999_500, 9_949_999, 9_950_000].map(size)).toEqual([
      '999 byte',
      '1 kB',
      '999 kB',
      '1.0 MB',
      '9.9 MB',
      '10 MB',
    ]);
  });

  it('counts time back from now', () => {
    const now = Date.parse('2025-06-15T12:00:00Z');
    expect(ago('2025-06-15T11:59:30Z', now)).toBe('just now');
    expect(ago('2025-06-15T11:57:00Z', now)).toBe('3 min. ago');
    expect(ago('2025-06-15T07:00:00Z', now)).toBe('5 hr. ago');
    expect(ago('2025-06-14T11:00:00Z', now)).toBe('yesterday');
  });

  it('takes the ending off a file name, and nothing else', () => {
    expect(['aunt mary.jpg', 'no ending', '.hidden', 'v1.2 final.webp'].map(stem)).toEqual([
      'aunt mary',
      'no ending',
      '.hidden',
      'v1.2 final',
    ]);
  });
});

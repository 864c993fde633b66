import { apart, AT_REST, followerTime, TOLERANCE } from '@web/result/sync';
import { describe, expect, it } from 'vitest';

describe('two videos in step', () => {
  it('begins the performance where its trimmed part begins', () => {
    expect(followerTime(0, 2.5, 10)).toBe(2.5);
    expect(followerTime(3, 2.5, 10)).toBe(5.5);
  });

  it('rests on the last frame of a shorter performance', () => {
    expect(followerTime(9, 2.5, 10)).toBeCloseTo(10, 2);
    expect(followerTime(9, 2.5, 10)).toBeLessThan(10);
  });

  it('asks nothing of a performance that is not loaded', () => {
    expect(followerTime(9, 2.5, NaN)).toBe(11.5);
  });

  it('leaves a difference of one frame alone while they play, and mends three', () => {
    expect(apart(1, 1 + 1 / 25, TOLERANCE)).toBe(false);
    expect(apart(1, 1 + 3 / 25, TOLERANCE)).toBe(true);
    expect(apart(1 + 3 / 25, 1, TOLERANCE)).toBe(true);
  });

  it('mends the difference of one frame at rest', () => {
    expect(apart(1, 1 + 1 / 60, AT_REST)).toBe(true);
  });
});

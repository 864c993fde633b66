import { features, lines, membersOf, POINTS, steps } from '@web/kinds/portrait/landmarks/scheme';
import { describe, expect, it } from 'vitest';

describe('the 68 points', () => {
  it('belong to one feature each', () => {
    const members = features.flatMap(membersOf);
    expect(members.sort((a, b) => a - b)).toEqual(Array.from({ length: POINTS }, (_, index) => index));
    expect(lines.reduce((sum, { from, to }) => sum + to - from, 0)).toBe(POINTS);
  });

  it('neighbour along their lines, which eyes and lips close', () => {
    expect([steps(36, 41), steps(36, 39), steps(0, 16), steps(17, 22), steps(48, 60)]).toEqual([
      1,
      3,
      16,
      Infinity,
      Infinity,
    ]);
  });
});

import { groups, mixtures, unitWords, visemes } from '@web/viewer/expressions/units';
import { describe, expect, it } from 'vitest';

const units = Object.values(groups).flat();

describe('face units', () => {
  it('are 52, each in one group', () => {
    expect(units).toHaveLength(52);
    expect(new Set(units).size).toBe(52);
  });

  it('are what mixtures are made of', () => {
    for (const mixture of Object.values(mixtures)) {
      for (const [unit, share] of Object.entries(mixture)) {
        expect(units).toContain(unit);
        expect(share).toBeGreaterThan(0);
        expect(share).toBeLessThanOrEqual(1);
      }
    }
    expect(visemes).toHaveLength(15);
  });

  it('are told as words and a side', () => {
    expect(unitWords('mouthSmileLeft')).toEqual({ name: 'Mouth smile', side: 'Left' });
    expect(unitWords('browInnerUp')).toEqual({ name: 'Brow inner up', side: null });
    expect(unitWords('jawLeft')).toEqual({ name: 'Jaw left', side: null });
    expect(unitWords('eyeLookInRight')).toEqual({ name: 'Eye look in', side: 'Right' });
  });
});

import { fewer, outline, simplified } from '@web/kinds/character/masks/strokes';
import { toSegment } from '@web/picture_editor/geometry';
import { describe, expect, it } from 'vitest';

describe('a stroke', () => {
  const wave = Array.from({ length: 200 }, (_, i) => [i, 20 * Math.sin(i / 20)] as const);

  it('is sent with fewer places, from which what was drawn is never far', () => {
    const kept = fewer(wave, 1);
    expect(kept.length).toBeLessThan(40);
    expect([kept[0], kept.at(-1)]).toEqual([wave[0], wave.at(-1)]);
    for (const place of wave) {
      const nearest = Math.min(...kept.slice(1).map((end, index) => toSegment(place, kept[index]!, end)));
      expect(nearest).toBeLessThanOrEqual(1 + 1e-9);
    }
  });

  it('keeps what says what it covers, in tenths of a pixel', () => {
    expect(simplified({ path: [[1.234, 5.678]], radius: 4.44, person: false })).toEqual({
      ...{ path: [[1.2, 5.7]], radius: 4.4, person: false },
    });
    const there = simplified({ path: [[0, 0], [5, 0.1], [10, 0]], radius: 8, part: 'head' as const });
    expect([there.path, there.part]).toEqual([[[0, 0], [10, 0]], 'head']);
  });

  it('that comes back to where it began keeps its way', () => {
    expect(fewer([[0, 0], [10, 0], [10, 10], [0, 0]], 0.5)).toEqual([[0, 0], [10, 0], [10, 10], [0, 0]]);
  });

  it('is drawn as a line, or as a dab', () => {
    expect(outline({ path: [[1, 2]], radius: 1 })).toBe('M1 2h0');
    expect(outline({ path: [[1, 2], [3, 4]], radius: 1 })).toBe('M1 2L3 4');
  });
});

import { faceInBox, facePlaced } from '@web/kinds/portrait/landmarks/template';
import { boxAround } from '@web/picture_editor/transforms';
import { describe, expect, it } from 'vitest';

describe('the face to begin with', () => {
  it('lies within the picture, upright, whatever its shape', () => {
    for (const [width, height] of [
      [600, 800],
      [1920, 400],
      [64, 64],
    ] as const) {
      const box = boxAround(facePlaced(width, height));
      expect(box.x).toBeGreaterThan(0);
      expect(box.y).toBeGreaterThan(0);
      expect(box.x + box.width).toBeLessThan(width);
      expect(box.y + box.height).toBeLessThan(height);
    }
  });

  it('fills the width of a face that was found, chin at the lower edge', () => {
    const box = boxAround(faceInBox([100, 50, 200, 260]));
    expect([box.x, box.width, box.y + box.height].map((v) => Math.round(v))).toEqual([100, 200, 310]);
  });
});

import { corners, frusta } from '@web/viewer/cloud/frusta';
import { describe, expect, it } from 'vitest';

/** Two metres before the origin, looking at it: x of the picture is x of the world, y goes down, z goes away from the eye. */
const before = {
  size: [200, 400] as const,
  intrinsics: [[100, 0, 100], [0, 100, 200], [0, 0, 1]],
  rotation: [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
  translation: [0, 1, 2],
};

describe('a camera as a pyramid', () => {
  it('has its tip in the eye and its base where the picture’s corners are seen', () => {
    const [eye, topLeft, , bottomRight] = corners(before, 0.5);
    expect(eye).toEqual([0, 1, 2]);
    [-0.5, 2, 1.5].forEach((value, axis) => expect(topLeft![axis]).toBeCloseTo(value, 12));
    [0.5, 0, 1.5].forEach((value, axis) => expect(bottomRight![axis]).toBeCloseTo(value, 12));
  });

  it('is eight lines', () => {
    const pyramids = frusta([before, before], 0.1, 0xff0000);
    expect(pyramids.geometry.attributes.position?.count).toBe(2 * 8 * 2);
  });
});

import { enlarged, frameBetween, movedFrame } from '@web/kinds/character/people/boxes';
import { describe, expect, it } from 'vitest';

describe('a frame', () => {
  const size = [100, 200] as const;

  it('lies between two corners, within the picture, whichever way it is drawn', () => {
    expect(frameBetween([60, 150], [20, -50], size)).toEqual([20, 0, 40, 150]);
    expect(frameBetween([100, 200], [100, 200], size)).toEqual([92, 192, 8, 8]);
  });

  it('keeps its size where it is moved, and its middle where it is made larger', () => {
    expect(movedFrame([80, 10, 20, 20], 50, -50, size)).toEqual([80, 0, 20, 20]);
    expect(enlarged([40, 90, 20, 20], 5, 10, size)).toEqual([35, 80, 30, 40]);
  });
});

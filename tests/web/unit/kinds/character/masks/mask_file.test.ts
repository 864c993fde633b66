import { readMask, readParts } from '@web/kinds/character/masks/mask_file';
import { describe, expect, it } from 'vitest';

const read = (how: (pixels: Uint8ClampedArray) => void, ...pixels: number[][]): number[] => {
  const all = Uint8ClampedArray.from(pixels.flat());
  how(all);
  return [...all];
};

describe('a file in place of a mask', () => {
  it('is white where it is bright', () => {
    expect(read(readMask, [255, 255, 255, 255], [0, 0, 0, 255], [30, 60, 90, 255])).toEqual([
      ...[255, 255, 255, 255, 0, 0, 0, 255, 60, 60, 60, 255],
    ]);
  });

  it('is white where somebody cut out is, whatever they wear', () => {
    expect(read(readMask, [10, 20, 30, 255], [255, 255, 255, 0])).toEqual([255, 255, 255, 255, 0, 0, 0, 255]);
  });
});

describe('a file in place of the parts', () => {
  it('has the nearest of their colours, and nothing where it is nearly black', () => {
    expect(read(readParts, [251, 178, 66, 255], [60, 160, 220, 255], [20, 20, 20, 255])).toEqual([
      ...[250, 180, 60, 255, 60, 160, 220, 255, 0, 0, 0, 0],
    ]);
  });
});

import type { Point } from '@web/picture_editor/geometry';
import { around, whole, zoomed } from '@web/picture_editor/view';
import { describe, expect, it } from 'vitest';

const close = (a: readonly Point[], b: readonly Point[]): void =>
  a.forEach(([x, y], index) => {
    expect(x).toBeCloseTo(b[index]?.[0] ?? NaN, 6);
    expect(y).toBeCloseTo(b[index]?.[1] ?? NaN, 6);
  });

describe('the view', () => {
  const picture = whole(600, 800);

  it('keeps a place where it is while it comes nearer', () => {
    const near = zoomed(picture, 2, [200, 300], picture);
    expect(near.width).toBe(300);
    expect((200 - near.x) / near.width).toBeCloseTo((200 - picture.x) / picture.width);
  });

  it('never shows more than the picture', () => {
    const back = zoomed(zoomed(picture, 3, [0, 0], picture), 0.1, [500, 700], picture);
    close([[back.x, back.y]], [[picture.x, picture.y]]);
    close([[back.width, back.height]], [[picture.width, picture.height]]);
    const corner = around({ x: 560, y: 760, width: 30, height: 30 }, 1, picture);
    expect(corner.x + corner.width).toBeLessThanOrEqual(599.5);
    expect(corner.y + corner.height).toBeLessThanOrEqual(799.5);
  });
});

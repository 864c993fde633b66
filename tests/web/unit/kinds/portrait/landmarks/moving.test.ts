import { nearestFeature, shares } from '@web/kinds/portrait/landmarks/moving';
import { facePlaced } from '@web/kinds/portrait/landmarks/template';
import { boxAround, middle, moved, resized } from '@web/picture_editor/transforms';
import { nearest, type Point } from '@web/picture_editor/geometry';
import { describe, expect, it } from 'vitest';

const points = facePlaced(600, 800);
const close = (a: readonly Point[], b: readonly Point[]): void =>
  a.forEach(([x, y], index) => {
    expect(x).toBeCloseTo(b[index]?.[0] ?? NaN, 6);
    expect(y).toBeCloseTo(b[index]?.[1] ?? NaN, 6);
  });

describe('a gesture', () => {
  it('moves a feature and nothing else', () => {
    const after = moved(points, shares({ by: 'feature', feature: 'lips' }, true), 5, -3);
    points.forEach(([x, y], index) => {
      const lips = index >= 48;
      expect(after[index]).toEqual(lips ? [x + 5, y - 3] : [x, y]);
    });
  });

  it('takes the neighbours of a single point along, less and less, but not the other lid', () => {
    const share = shares({ by: 'point', feature: 'leftEye', index: 37 }, true);
    expect([share[37], share[38], share[36], share[39], share[41], share[40]]).toEqual([1, 0.5, 0.5, 0.15, 0.15, 0]);
    expect(shares({ by: 'point', feature: 'leftEye', index: 37 }, false).filter(Boolean)).toEqual([1]);
  });

  it('makes larger and turns around the middle of what is chosen, and is undone by its inverse', () => {
    const share = shares({ by: 'feature', feature: 'rightEye' }, true);
    const after = resized(points, share, 2, 0);
    expect(boxAround(after, share).width).toBeCloseTo(2 * boxAround(points, share).width);
    close([middle(after, share)], [middle(points, share)]);
    const face = shares({ by: 'face' }, true);
    const quarter = resized(points, face, 1, Math.PI / 2);
    expect(boxAround(quarter).width).toBeCloseTo(boxAround(points).height);
    close(resized(quarter, face, 1, -Math.PI / 2), points);
  });

  it('takes hold of what is nearest, and of nothing that is far', () => {
    const [x, y] = points[30] as Point;
    expect(nearest(points, [x + 2, y], 10)).toBe(30);
    expect(nearest(points, [1, 1], 10)).toBeNull();
    const [a, b] = [points[2] as Point, points[3] as Point];
    expect(nearestFeature(points, [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], 5)).toBe('chin'); // between two points
  });
});

import { nearestFeature, shares } from '@web/kinds/portrait/landmarks/moving';
import { features, lines, membersOf, POINTS, type Points, steps } from '@web/kinds/portrait/landmarks/scheme';
import { canonical, faceInBox, facePlaced } from '@web/kinds/portrait/landmarks/template';
import { begun, canRedo, canUndo, type History, step } from '@web/stage/history';
import { boxAround, middle, moved, resized } from '@web/stage/moving';
import { nearest, type Point } from '@web/stage/place';
import { around, whole, zoomed } from '@web/stage/view';
import { describe, expect, it } from 'vitest';

const points = facePlaced(600, 800);
const close = (a: readonly Point[], b: readonly Point[]): void =>
  a.forEach(([x, y], index) => {
    expect(x).toBeCloseTo(b[index]?.[0] ?? NaN, 6);
    expect(y).toBeCloseTo(b[index]?.[1] ?? NaN, 6);
  });

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

describe('undo and redo', () => {
  const gesture = (history: History<Points>, ...changes: Points[]): History<Points> =>
    changes.reduce((so, changed) => step(so, { type: 'change', state: changed }), step(history, { type: 'begin' }));
  const [one, two] = [[...canonical], [...canonical]];

  it('take a whole gesture back, and bring it again', () => {
    const after = gesture(gesture(begun<Points>(points), one), [], two);
    const back = step(after, { type: 'undo' });
    expect([back.state, canUndo(back), canRedo(back)]).toEqual([one, true, true]);
    expect(step(back, { type: 'redo' }).state).toBe(two);
    const start = step(back, { type: 'undo' });
    expect([start.state, canUndo(start)]).toEqual([points, false]);
  });

  it('know nothing of a gesture that moved nothing', () => {
    const touched = step(begun<Points>(points), { type: 'begin' });
    expect(canUndo(touched)).toBe(false);
    expect(step(gesture(touched, one), { type: 'undo' }).state).toBe(points);
  });
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

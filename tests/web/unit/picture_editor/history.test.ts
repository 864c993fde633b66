import type { Points } from '@web/kinds/portrait/landmarks/scheme';
import { canonical, facePlaced } from '@web/kinds/portrait/landmarks/template';
import { begun, canRedo, canUndo, type History, step } from '@web/picture_editor/history';
import { describe, expect, it } from 'vitest';

const points = facePlaced(600, 800);

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

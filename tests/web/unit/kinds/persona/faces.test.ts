import { changesOf, draftOf, isChanged, isUsed, revisionOf, toggled } from '@web/kinds/persona/corrections/changes';
import { nextPlace } from '@web/kinds/persona/faces/face_buttons';
import { groupsOf } from '@web/kinds/persona/faces/face_groups';
import type { Face } from '@web/kinds/persona/types';
import { describe, expect, it } from 'vitest';
import { aJob } from '../../job';

const face = (reason: string | null): Face => ({ photo: 'a.jpg', kept: reason === null, reason });
const sheet = (...reasons: (string | null)[]) => ({ tile: 96, columns: 16, faces: reasons.map(face), skipped: [] });

describe('the faces of a collection', () => {
  it('stand by what became of them: those that are used, those in doubt, the others, and what a later service may say', () => {
    expect(groupsOf(sheet('somebody_else', null, 'uncertain', 'sideways', null, 'turned'))).toEqual([
      { reason: null, faces: [1, 4] },
      { reason: 'uncertain', faces: [2] },
      { reason: 'turned', faces: [5] },
      { reason: 'somebody_else', faces: [0] },
      { reason: 'sideways', faces: [3] },
    ]);
  });

  it('are gone through by keys, from the first to the last', () => {
    expect(['ArrowRight', 'ArrowLeft', 'Home', 'End', 'a'].map((key) => nextPlace(key, 1, 4))).toEqual([2, 0, 0, 3, null]);
    expect([nextPlace('ArrowRight', 3, 4), nextPlace('ArrowUp', 0, 4)]).toEqual([null, null]);
  });
});

describe('decisions about faces', () => {
  const none = { keep: [], leaveOut: [] };

  it('are the other one at a click, and none at the next', () => {
    const kept = toggled(3, face(null), none, none);
    expect(kept).toEqual({ keep: [], leaveOut: [3] });
    expect(toggled(3, face(null), none, kept)).toEqual(none);
    const dropped = toggled(2, face('turned'), none, kept);
    expect(dropped).toEqual({ keep: [2], leaveOut: [3] });
    expect(toggled(2, face('turned'), none, dropped)).toEqual(kept);
  });

  it('of the job before are taken back to what the faces are by themselves', () => {
    const before = { keep: [2], leaveOut: [3] };
    expect([isUsed(2, face(null), before, before), isUsed(3, face('left_out'), before, before)]).toEqual([true, false]);
    expect(toggled(2, face(null), before, before)).toEqual({ keep: [], leaveOut: [3] });
    expect(toggled(3, face('left_out'), before, before)).toEqual({ keep: [2], leaveOut: [] });
    expect(isUsed(3, face('left_out'), before, none)).toBe(true);
  });
});

describe('a revision of a persona', () => {
  const job = aJob({ kind: 'persona', options: { keep: [2], example: 4, composite: 'side_by_side' }, metadata: { picture: 'Aunt', performance: 'Happy' } });
  const before = draftOf(job);

  it('asks for nothing where nothing is changed', () => {
    expect(isChanged(before, before)).toBe(false);
    expect(changesOf(before, before)).toEqual({ corrections: {}, options: {} });
  });

  it('asks for faces, the person, and what is drawn; what is as by itself is taken back', () => {
    const now = { ...before, keep: [], leaveOut: [7], example: null, options: { background: [1, 2, 3] } };
    expect(changesOf(before, now)).toEqual({
      corrections: { keep: null, leave_out: [7], example: null },
      options: { composite: null, background: [1, 2, 3] },
    });
  });

  it('names what is played now', () => {
    const video = new File(['x'], 'a_wave.mp4');
    const { files, changes } = revisionOf(job, before, { ...before, performance: { by: 'file', file: video } });
    expect(files).toEqual([['driver', video]]);
    expect(changes({ driver: 'd' })).toEqual({ corrections: { driver: 'd' }, options: {}, metadata: { picture: 'Aunt', performance: 'A wave' } });
    const named = { ...before, performance: { by: 'name', name: 'wink' } as const };
    expect(revisionOf(job, before, named).changes({}).corrections).toEqual({ driver: 'wink' });
    expect(isChanged(before, named)).toBe(true);
  });
});

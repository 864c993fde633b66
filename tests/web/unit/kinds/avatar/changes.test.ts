import type { Job } from '@web/api';
import { changesOf, draftOf, isChanged, revisionOf } from '@web/kinds/avatar/corrections/changes';
import { landmarkName, placeIn, withPlace } from '@web/kinds/avatar/corrections/landmarks';
import { describe, expect, it } from 'vitest';
import { aJob } from '../../job';

const job = (options: object = {}, inputs: object = {}): Job =>
  aJob({ kind: 'avatar', options: { ...options }, inputs: { body: 'b', ...inputs }, metadata: { picture: 'Me', performance: 'Talk' } });

describe('a revision of an avatar', () => {
  it('asks for nothing where nothing is changed', () => {
    const before = draftOf(job({ height_m: 1.8, body_frames_left_out: [3], motion: 'walk' }, { driver: 'd' }));
    expect(changesOf(before, { ...before, height: '180 cm' })).toEqual({ corrections: {}, options: {} });
    expect(isChanged(before, before)).toBe(false);
  });

  it('asks for height, frames, joints, motion and files', () => {
    const before = draftOf(job({ height_m: 1.8, head_frames_left_out: [3] }));
    const elbow = [{ frame: 4, place: [1, 2] as const }, { frame: 9, place: [3, 4] as const }];
    const now = {
      ...before,
      height: '',
      leftOut: { body: [4, 9], head: [] },
      landmarks: { LeftElbow: elbow, Nose: elbow.slice(1) },
      motion: { by: 'name', name: 'dance' } as const,
      options: { vrm: true },
    };
    expect(changesOf(before, now, { driver: 'd2' })).toEqual({
      corrections: {
        ...{ height_m: null, body_frames_left_out: [4, 9], head_frames_left_out: null },
        ...{ landmarks: { LeftElbow: elbow }, driver: 'd2' },
      },
      options: { vrm: true, motion: 'dance' },
    });
  });

  it('takes the driver away, and names what is acted out now', () => {
    const given = job({}, { driver: 'd' });
    const before = draftOf(given);
    const now = { ...before, driver: null };
    expect(changesOf(before, now).corrections).toEqual({ driver: null });
    expect(revisionOf(given, before, now).changes({}).metadata).toEqual({ picture: 'Me' });
  });
});

describe('a joint that is shown by hand', () => {
  it('has one place in a frame, which can be moved and taken back', () => {
    const twice = withPlace(withPlace({}, 'Nose', 9, [1, 2]), 'Nose', 4, [3, 4]);
    expect(twice).toEqual({ Nose: [{ frame: 4, place: [3, 4] }, { frame: 9, place: [1, 2] }] });
    expect(placeIn(withPlace(twice, 'Nose', 9, [5, 6]), 'Nose', 9)).toEqual([5, 6]);
    expect(withPlace(withPlace(twice, 'Nose', 9, null), 'Nose', 4, null)).toEqual({});
  });

  it('is told in words', () => {
    expect(landmarkName('LeftFootIndex')).toBe('Left toes');
    expect(landmarkName('Nose')).toBe('Nose');
  });
});

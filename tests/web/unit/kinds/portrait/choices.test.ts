import type { PortraitOptions } from '@web/kinds/portrait/types';
import { choicesOf, optionsOf, usual } from '@web/kinds/portrait/choices';
import { revisionOptions, sameFrames, wishesOf } from '@web/kinds/portrait/corrections/changes';
import { describe, expect, it } from 'vitest';

describe('options', () => {
  it('sends only what differs from the usual', () => {
    expect(optionsOf(usual, true)).toEqual({});
    expect(optionsOf({ strength: 0.5, follow: ['eyes', 'head'], sound: true, loop: true }, true)).toEqual({
      strength: 0.5,
      follow: ['eyes', 'head'],
      sound: true,
      loop: true,
    });
  });

  it('shows what a job was made with, in the order of the page', () => {
    expect(choicesOf({})).toEqual(usual);
    expect(choicesOf({ strength: 0.5, follow: ['head', 'eyes'], sound: true, loop: true })).toEqual({
      strength: 0.5,
      follow: ['eyes', 'head'],
      sound: true,
      loop: true,
    });
  });

  it('takes back to the default what a revision no longer wants', () => {
    const nothing = { strength: null, follow: null, sound: null, loop: null, neutral_frame: null };
    expect(revisionOptions(wishesOf({}))).toEqual({
      ...{ ...nothing, trim: null, driver_face_index: null, head_3d: null },
      ...{ face_index: null, crop: null, size: null, fps: null, format: null, landmarks: null },
    });
  });

  it('asks in a revision for what the job was made with, where nothing was changed', () => {
    const made: PortraitOptions = {
      ...{ strength: 1.2, follow: ['mouth'], sound: true, loop: true, neutral_frame: 12 },
      ...{ trim: [1.5, 4], driver_face_index: 1, head_3d: false },
      ...{ face_index: 1, crop: 'bust', size: [512, 512], fps: 25, format: 'webm', landmarks: [[1, 2]] },
    };
    expect(revisionOptions(wishesOf(made))).toEqual(made);
  });

  it('uses a performance from its beginning where only an end is said', () => {
    expect(revisionOptions({ ...wishesOf({}), trim: [null, 3] }).trim).toEqual([0, 3]);
  });

  it('knows when frames of the performance have other numbers', () => {
    const wishes = wishesOf({ trim: [1, 4] });
    expect(sameFrames(wishes, { ...wishesOf({ trim: [1, 4] }), strength: 0.5 })).toBe(true);
    expect(sameFrames(wishes, { ...wishes, trim: [2, 4] })).toBe(false);
    expect(sameFrames(wishes, { ...wishes, rate: 25 })).toBe(false);
    expect(sameFrames(wishes, { ...wishes, driverFace: 1 })).toBe(false);
  });

  it('asks for no sound of a performance that has none', () => {
    expect(optionsOf({ ...usual, sound: true }, false)).toEqual({});
  });
});

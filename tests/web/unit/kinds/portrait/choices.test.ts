import type { PortraitOptions } from '@web/kinds/portrait/types';
import { choicesOf, optionsOf, defaults } from '@web/kinds/portrait/choices';
import { revisionOptions, sameFrames, draftOf } from '@web/kinds/portrait/corrections/changes';
import { describe, expect, it } from 'vitest';

describe('options', () => {
  it('sends only what differs from the defaults', () => {
    expect(optionsOf(defaults, true)).toEqual({});
    expect(optionsOf({ strength: 0.5, follow: ['eyes', 'head'], sound: true, loop: true }, true)).toEqual({
      strength: 0.5,
      follow: ['eyes', 'head'],
      sound: true,
      loop: true,
    });
  });

  it('shows what a job was made with, in the order of the page', () => {
    expect(choicesOf({})).toEqual(defaults);
    expect(choicesOf({ strength: 0.5, follow: ['head', 'eyes'], sound: true, loop: true })).toEqual({
      strength: 0.5,
      follow: ['eyes', 'head'],
      sound: true,
      loop: true,
    });
  });

  it('takes back to the default what a revision no longer wants', () => {
    const nothing = { strength: null, follow: null, sound: null, loop: null, neutral_frame: null };
    expect(revisionOptions(draftOf({}))).toEqual({
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
    expect(revisionOptions(draftOf(made))).toEqual(made);
  });

  it('uses a performance from its beginning where only an end is said', () => {
    expect(revisionOptions({ ...draftOf({}), trim: [null, 3] }).trim).toEqual([0, 3]);
  });

  it('knows when frames of the performance have other numbers', () => {
    const draft = draftOf({ trim: [1, 4] });
    expect(sameFrames(draft, { ...draftOf({ trim: [1, 4] }), strength: 0.5 })).toBe(true);
    expect(sameFrames(draft, { ...draft, trim: [2, 4] })).toBe(false);
    expect(sameFrames(draft, { ...draft, rate: 25 })).toBe(false);
    expect(sameFrames(draft, { ...draft, driverFace: 1 })).toBe(false);
  });

  it('asks for no sound of a performance that has none', () => {
    expect(optionsOf({ ...defaults, sound: true }, false)).toEqual({});
  });
});

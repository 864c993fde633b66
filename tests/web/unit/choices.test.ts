import { choicesOf, optionsOf, usual } from '@web/components/choices';
import { revisionOptions, type Wishes } from '@web/corrections/changes';
import { describe, expect, it } from 'vitest';

describe('options', () => {
  it('sends only what differs from the usual', () => {
    expect(optionsOf(usual, true)).toEqual({});
    expect(optionsOf({ strength: 0.5, follow: ['eyes', 'head'], sound: true }, true)).toEqual({
      strength: 0.5,
      follow: ['eyes', 'head'],
      sound: true,
    });
  });

  it('shows what a job was made with, in the order of the page', () => {
    expect(choicesOf({})).toEqual(usual);
    expect(choicesOf({ strength: 0.5, follow: ['head', 'eyes'], sound: true })).toEqual({
      strength: 0.5,
      follow: ['eyes', 'head'],
      sound: true,
    });
  });

  it('takes back to the default what a revision no longer wants', () => {
    const wishes: Wishes = { ...usual, neutral: null, face: 0, crop: 'none', size: null, landmarks: null };
    const nothing = { strength: null, follow: null, sound: null, neutral_frame: null };
    expect(revisionOptions(wishes)).toEqual({ ...nothing, face_index: null, crop: null, size: null, landmarks: null });
    expect(
      revisionOptions({
        ...{ strength: 1.2, follow: ['mouth'], sound: true, neutral: 12 },
        ...{ face: 1, crop: 'bust', size: [512, 512], landmarks: [[1, 2]] },
      }),
    ).toEqual({
      ...{ strength: 1.2, follow: ['mouth'], sound: true, neutral_frame: 12 },
      ...{ face_index: 1, crop: 'bust', size: [512, 512], landmarks: [[1, 2]] },
    });
  });

  it('asks for no sound of a performance that has none', () => {
    expect(optionsOf({ ...usual, sound: true }, false)).toEqual({});
  });
});

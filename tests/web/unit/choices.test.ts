import { optionsOf, usual } from '@web/components/choices';
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

  it('asks for no sound of a performance that has none', () => {
    expect(optionsOf({ ...usual, sound: true }, false)).toEqual({});
  });
});

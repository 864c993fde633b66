import { choicesOf, optionsOf, defaults } from '@web/kinds/character/choices';
import { describe, expect, it } from 'vitest';

describe('the options of a character', () => {
  it('sends only what differs from the defaults', () => {
    expect(optionsOf(defaults)).toEqual({});
    expect(optionsOf({ ...defaults, keep: ['right_arm', 'head'], back: 'inpaint', surface: 'shell', lit: true, vrm: true })).toEqual({
      ...{ keep: ['head', 'right_arm'], back_texture: 'inpaint', surface: 'shell', lit: true, vrm: true },
    });
    expect(optionsOf({ ...defaults, vrm: true, author: ' Ada ' })).toEqual({ vrm: true, vrm_author: 'Ada' });
    expect(optionsOf({ ...defaults, author: '  ' })).toEqual({});
    expect(optionsOf({ ...defaults, size: [512, 512], rate: 24, format: 'webp', triangles: 10_000, levels: 2 })).toEqual({
      ...{ size: [512, 512], fps: 24, format: 'webp', triangles: 10_000, levels: 2 },
    });
  });

  it('shows what a job was made with, names for two parts included', () => {
    expect(choicesOf({})).toEqual(defaults);
    expect(choicesOf({ keep: ['legs', 'head'], camera: 'orbit' }).keep).toEqual(['head', 'left_leg', 'right_leg']);
    expect(choicesOf({ lit: true })).toEqual({ ...defaults, lit: true });
    expect(choicesOf({ size: [640, 480], fps: 12.5, format: 'png', triangles: 5000, levels: 1 })).toEqual({
      ...{ ...defaults, size: [640, 480], rate: 12.5, format: 'png', triangles: 5000, levels: 1 },
    });
    expect(choicesOf({ vrm: true, vrm_author: 'Ada' })).toEqual({ ...defaults, vrm: true, author: 'Ada' });
  });
});

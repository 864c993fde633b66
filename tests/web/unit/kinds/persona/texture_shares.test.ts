import { sharesOf } from '@web/kinds/persona/puppet/texture_shares';
import { expect, it } from 'vitest';

const textures = [
  { name: 'neutral', units: {} },
  { name: 'smile', units: { mouthSmileLeft: 0.8, mouthSmileRight: 0.8 } },
  { name: 'open_mouth', units: { jawOpen: 0.5 } },
];

it('shows the neutral texture at rest, and all of an expression’s where its units are moved as far as there', () => {
  expect(sharesOf(textures, {})).toEqual([1, 0, 0]);
  expect(sharesOf(textures, { mouthSmileLeft: 0.8, mouthSmileRight: 0.8 })).toEqual([0, 1, 0]);
  expect(sharesOf(textures, { jawOpen: 1 })).toEqual([0, 0, 1]);
});

it('shows as much of it as the least moved unit has come, and parts of two where a face does both', () => {
  expect(sharesOf(textures, { mouthSmileLeft: 0.8 })).toEqual([1, 0, 0]);
  expect(sharesOf(textures, { mouthSmileLeft: 0.8, mouthSmileRight: 0.4, jawOpen: 0.125 })).toEqual([0.25, 0.5, 0.25]);
  const both = sharesOf(textures, { mouthSmileLeft: 1, mouthSmileRight: 1, jawOpen: 1 });
  expect(both).toEqual([0, 0.5, 0.5]);
});

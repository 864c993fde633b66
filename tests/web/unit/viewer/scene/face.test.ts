import { Face } from '@web/viewer/scene/face';
import { AnimationClip, BufferGeometry, Mesh, NumberKeyframeTrack } from 'three';
import { describe, expect, it } from 'vitest';

/** A mesh with two targets, and a clip that opens its jaw within a second. */
function somebody() {
  const mesh = new Mesh(new BufferGeometry());
  mesh.name = 'head';
  mesh.morphTargetDictionary = { jawOpen: 0, eyeBlinkLeft: 1 };
  mesh.morphTargetInfluences = [0, 0];
  const speech = new NumberKeyframeTrack('head.morphTargetInfluences', [0, 1], [0, 0, 1, 0.5]);
  const clip = new AnimationClip('talk', 1, [speech, new NumberKeyframeTrack('head.scale', [0], [1])]);
  return { face: new Face([mesh, new Mesh(new BufferGeometry())], [clip]), clip, shown: mesh.morphTargetInfluences };
}

describe('a face', () => {
  it('does what a clip has it do at each second, and nothing without one', () => {
    const { face, clip, shown } = somebody();
    expect(face.names).toEqual(['jawOpen', 'eyeBlinkLeft']);
    face.act(clip, 0.5);
    expect(shown).toEqual([0.5, 0.25]);
    face.act(null);
    expect(shown).toEqual([0, 0]);
  });

  it('leaves the mixer what moves joints alone', () => {
    const { clip } = somebody();
    expect(clip.tracks.map(({ name }) => name)).toEqual(['head.scale']);
  });

  it('adds what is set by hand, up to all of it, and takes it back', () => {
    const { face, clip, shown } = somebody();
    face.act(clip, 0.5);
    face.set({ jawOpen: 0.8, eyeBlinkLeft: 0.25, unknown: 1 });
    expect(shown).toEqual([1, 0.5]);
    face.set({});
    expect(shown).toEqual([0.5, 0.25]);
  });
});

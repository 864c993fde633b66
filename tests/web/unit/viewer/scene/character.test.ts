import { repeats } from '@web/viewer/scene/character';
import { AnimationClip, QuaternionKeyframeTrack, VectorKeyframeTrack } from 'three';
import { describe, expect, it } from 'vitest';

const turning = (...x: number[]) =>
  new QuaternionKeyframeTrack('Spine.quaternion', [...x.keys()], x.flatMap((value) => [value, 0, 0, Math.sqrt(1 - value * value)]));
const going = (...z: number[]) => new VectorKeyframeTrack('Hips.position', [...z.keys()], z.flatMap((value) => [0, 1, value]));

describe('a clip is played on and on', () => {
  it.each([
    ['where it says that it loops, though it travels', true, [going(0, 1)], true],
    ['where it moves and comes back', true, [going(0, 0, 0), turning(0, 0.5, 0)], false],
    ['not where it ends in another pose', false, [going(0, 0, 0), turning(0, 0.5, 0.4)], false],
    ['not where it ends in another place', false, [going(0, 0, 1), turning(0, 0.5, 0)], false],
    ['not where nothing moves: that would be drawn for nothing', false, [going(0, 0), turning(0.5, 0.5)], false],
  ])('%s', (_, expected, tracks, loops) => {
    const clip = new AnimationClip('some', -1, tracks);
    if (loops) clip.userData.loops = true;
    expect(repeats(clip)).toBe(expected);
  });
});

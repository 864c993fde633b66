import type { Character } from '@web/viewer/scene/character';
import { Playback } from '@web/viewer/orbit/playback';
import { AnimationClip } from 'three';
import { describe, expect, it } from 'vitest';

/** Somebody whose clips last so long, and where in them they were last. */
function somebody(clips: Record<string, number>, loop: boolean) {
  const all = Object.entries(clips).map(([name, seconds]) => {
    const clip = new AnimationClip(name, seconds, []);
    clip.userData.loops = loop;
    return clip;
  });
  const at: number[] = [];
  const character = { clip: (name: string) => all.find((one) => one.name === name), settle: () => undefined, show: (_: object, second: number) => at.push(second) };
  return { character: character as unknown as Character, now: () => at.at(-1) };
}

describe('a clip that several people play', () => {
  it('goes around for each in their own time', () => {
    const [first, second] = [somebody({ walk: 2 }, true), somebody({ walk: 3 }, true)];
    const playback = new Playback([first.character, second.character], 'walk', () => undefined);
    playback.play();
    expect(playback.advance(2.5)).toBe(true);
    expect([first.now(), second.now(), playback.time, playback.duration]).toEqual([0.5, 2.5, 0.5, 2]);
    playback.advance(1);
    expect([first.now(), second.now()]).toEqual([1.5, 0.5]);
  });

  it('ends with the longest, where it does not go around', () => {
    const [first, second] = [somebody({ out: 2 }, false), somebody({ out: 3 }, false)];
    const playback = new Playback([first.character, second.character], 'out', () => undefined);
    playback.play();
    expect(playback.advance(2.5)).toBe(true);
    expect(playback.advance(1)).toBe(false);
    expect([playback.time, playback.playing]).toEqual([3, false]);
    playback.play();
    playback.advance(0);
    expect([first.now(), second.now()]).toEqual([0, 0]);
  });
});

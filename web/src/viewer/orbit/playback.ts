/** A clip that everybody on the stage plays, each their own of that name, and where in it they are. */

import type { AnimationClip } from 'three';
import { type Character, repeats } from '../scene/character';
import type { Performer } from '../scene/stage';

export class Playback implements Performer {
  playing = false;
  speed = 1;
  private elapsed = 0;
  private looping = false;
  private parts: { character: Character; clip: AnimationClip }[] = [];

  constructor(
    private readonly cast: readonly Character[],
    clip: string,
    /** Is told after every step. */
    private readonly onTime: (time: number, playing: boolean) => void,
  ) {
    this.choose(clip);
  }

  /** Seconds of the longest; of one that loops, of the first. */
  get duration(): number {
    const durations = this.parts.map(({ clip }) => clip.duration);
    return this.looping ? (durations[0] ?? 0) : Math.max(0, ...durations);
  }

  get time(): number {
    return this.looping && this.elapsed > this.duration ? this.elapsed % this.duration : this.elapsed;
  }

  set time(time: number) {
    this.elapsed = time;
  }

  advance(seconds: number): boolean {
    if (this.playing) {
      this.elapsed += seconds * this.speed;
      if (this.elapsed >= this.duration && !this.looping) {
        this.elapsed = this.duration;
        this.playing = false;
      }
    }
    for (const { character, clip } of this.parts) {
      character.settle(clip);
      const round = this.looping && this.elapsed > clip.duration;
      character.show(clip, round ? this.elapsed % clip.duration : this.elapsed);
    }
    this.onTime(this.time, this.playing);
    return this.playing;
  }

  play(): void {
    if (this.elapsed >= this.duration && !this.looping) this.elapsed = 0;
    this.playing = true;
  }

  choose(name: string): void {
    this.elapsed = 0;
    this.parts = this.cast.flatMap((character) => {
      const clip = character.clip(name);
      return clip ? [{ character, clip }] : [];
    });
    const [first] = this.parts;
    this.looping = first !== undefined && first.clip.duration > 0 && repeats(first.clip);
  }
}

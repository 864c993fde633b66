/** A clip on a character, and where in it they are. */

import type { AnimationClip } from 'three';
import { type Character, loops } from './character';
import type { Performer } from './stage';

export class Playback implements Performer {
  playing = false;
  speed = 1;
  time = 0;

  constructor(
    private readonly character: Character,
    public clip: AnimationClip,
    /** Is told after every step. */
    private readonly onTime: (time: number, playing: boolean) => void,
  ) {}

  advance(seconds: number): boolean {
    const { duration } = this.clip;
    if (this.playing) {
      this.time += seconds * this.speed;
      if (this.time >= duration) {
        if (loops(this.clip)) this.time %= duration;
        else {
          this.time = duration;
          this.playing = false;
        }
      }
    }
    this.character.show(this.clip, this.time);
    this.onTime(this.time, this.playing);
    return this.playing;
  }

  play(): void {
    if (this.time >= this.clip.duration && !loops(this.clip)) this.time = 0;
    this.playing = true;
  }

  choose(clip: AnimationClip): void {
    this.clip = clip;
    this.time = 0;
  }
}

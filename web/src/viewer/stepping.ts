/** The course of things at the wall: in the picture, out of it, and on in the room. */

import { type AnimationClip, MathUtils, Vector3 } from 'three';
import { type Character, IN_PLACE, PICTURED, rootOf, STEP_OUT } from './character';
import type { Emerging } from './emerging';
import type { ContactShadow } from './shadow';
import type { Performer } from './stage';

/** Seconds in which paint becomes a body. */
const EMERGE = 1.3;
/** Seconds from the last step into what comes then. */
const SETTLE = 0.5;
/** Metres in a second from which on a motion travels: in one place it would look wrong in a room. */
const TRAVELS = 0.25;

export class Stepping implements Performer {
  playing = false;
  time = 0;
  private readonly stepOut: AnimationClip | undefined;
  private readonly after: AnimationClip | undefined;

  constructor(
    private readonly character: Character,
    private readonly emerging: Emerging,
    private readonly shadow: ContactShadow,
    private readonly onPlaying: (playing: boolean) => void,
  ) {
    this.stepOut = character.clip(STEP_OUT) ?? character.clip(PICTURED);
    this.after = this.stepOut && goingOn(character, this.stepOut);
  }

  advance(seconds: number): boolean {
    const { stepOut, after } = this;
    if (!stepOut) return false;
    if (this.playing) this.time += seconds;
    const body = MathUtils.smootherstep(this.time, 0, EMERGE);
    this.emerging.share = body;
    this.shadow.strength = body * body;
    const beyond = this.time - stepOut.duration;
    if (beyond <= 0 || !after) this.character.show(stepOut, this.time);
    else {
      const second = beyond % after.duration;
      const weight = MathUtils.smoothstep(beyond, 0, SETTLE);
      if (weight === 1) this.character.show(after, second);
      else {
        this.character.blend([
          { clip: stepOut, second: stepOut.duration, weight: 1 - weight },
          { clip: after, second, weight },
        ]);
      }
    }
    return this.playing;
  }

  /** How far the person has come, of the way that they will; 0 to 1. */
  get way(): number {
    return this.stepOut ? Math.min(1, this.time / this.stepOut.duration) : 0;
  }

  /** Where the way ends, on the floor. */
  get end(): Vector3 {
    const values = this.stepOut && rootOf(this.stepOut)?.values;
    return values ? new Vector3(values.at(-3), 0, values.at(-1)) : new Vector3();
  }

  set(playing: boolean): void {
    this.playing = playing;
    this.onPlaying(playing);
  }

  /** Into the picture again. */
  restart(playing: boolean): void {
    this.time = 0;
    this.set(playing);
  }
}

/** What the person does in the room, at the place where the steps ended: the motion where it stays in place, else standing. */
function goingOn(character: Character, stepOut: AnimationClip): AnimationClip | undefined {
  const still = character.clips.find(({ name }) => name.endsWith(IN_PLACE));
  const motion = still && character.clip(still.name.slice(0, -IN_PLACE.length));
  const chosen = still && motion && speed(motion) < TRAVELS ? still : (character.clip('idle') ?? still);
  if (!chosen) return undefined;
  const [end, begin] = [rootOf(stepOut), rootOf(chosen)];
  if (!end || !begin) return chosen;
  const clip = chosen.clone();
  const root = rootOf(clip);
  const values = root?.values;
  if (!values) return clip;
  const [dx, dz] = [end.values.at(-3)! - begin.values[0]!, end.values.at(-1)! - begin.values[2]!];
  for (let index = 0; index < values.length; index += 3) {
    values[index]! += dx;
    values[index + 2]! += dz;
  }
  return clip;
}

function speed(clip: AnimationClip): number {
  const values = rootOf(clip)?.values;
  if (!values || clip.duration === 0) return 0;
  return Math.hypot(values.at(-3)! - values[0]!, values.at(-1)! - values[2]!) / clip.duration;
}

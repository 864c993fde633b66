/** The course of things at the wall: in the picture, out of it, and on in the room. */

import { type AnimationClip, MathUtils, Vector3 } from 'three';
import { type Character, IN_PLACE, PICTURED, rootOf, STEP_OUT } from '../scene/character';
import type { Emergence } from './emergence';
import type { ContactShadow } from '../scene/shadow';
import type { Performer } from '../scene/stage';

/** Seconds in which there is nothing but a picture. */
const LINGER = 0.8;
/** Seconds in which paint becomes a body. */
const EMERGE = 1.3;
/** Seconds from the last step into what comes then. */
const SETTLE = 0.5;
/** Metres in a second from which on a motion travels: in one place it would look wrong in a room. */
const TRAVELS = 0.25;

/** Somebody who steps out: as paint, as a body, and their shadow. */
export interface Stepper {
  character: Character;
  emergence: Emergence;
  shadow: ContactShadow;
}

interface Steps extends Stepper {
  out: AnimationClip;
  after: AnimationClip | undefined;
}

export class StepOut implements Performer {
  playing = false;
  /** Seconds since the first began to move; less than 0 while all is paint. */
  time = 0;
  private readonly all: Steps[];
  /** Seconds in which the last has stepped out. */
  private readonly duration: number;

  constructor(
    steppers: readonly Stepper[],
    private readonly onPlaying: (playing: boolean) => void,
  ) {
    this.all = steppers.flatMap((stepper) => {
      const { character } = stepper;
      const out = character.clip(STEP_OUT) ?? character.clip(PICTURED);
      return out ? [{ ...stepper, out, after: goingOn(character, out) }] : [];
    });
    this.duration = Math.max(0, ...this.all.map(({ out }) => out.duration));
  }

  advance(seconds: number): boolean {
    if (this.playing) this.time += seconds;
    for (const one of this.all) this.bring(one);
    return this.playing && this.all.length > 0;
  }

  /** How far they have come, of the way that they will; 0 to 1. */
  get way(): number {
    return this.duration ? MathUtils.clamp(this.time / this.duration, 0, 1) : 0;
  }

  /** Where their ways end, on the floor. */
  get ends(): Vector3[] {
    return this.all.map(({ character, out }) => {
      const values = rootOf(out)?.values;
      const { x, z } = character.root.position;
      return values ? new Vector3(x + values.at(-3)!, 0, z + values.at(-1)!) : new Vector3(x, 0, z);
    });
  }

  set(playing: boolean): void {
    this.playing = playing;
    this.onPlaying(playing);
  }

  /** Into the picture again. */
  restart(playing: boolean): void {
    this.time = playing ? -LINGER : 0;
    this.set(playing);
  }

  private bring({ character, emergence, shadow, out, after }: Steps): void {
    const body = MathUtils.smootherstep(this.time, 0, EMERGE);
    emergence.share = body;
    shadow.strength = body * body;
    const beyond = this.time - out.duration;
    if (beyond <= 0 || !after) {
      character.show(out, Math.max(0, this.time));
      return;
    }
    const second = beyond % after.duration;
    const weight = MathUtils.smoothstep(beyond, 0, SETTLE);
    if (weight === 1) character.show(after, second);
    else {
      character.blend([
        { clip: out, second: out.duration, weight: 1 - weight },
        { clip: after, second, weight },
      ]);
    }
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

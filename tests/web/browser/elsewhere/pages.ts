/** What the pages that hold an avatar in another's program let the test do. */

import type { VRMHumanBoneName } from '@pixiv/three-vrm';

/** Metres. */
type Place = [number, number, number];

export interface TalkingHeadPage {
  /** Speak visemes, each so many milliseconds long, with a hum as sound. */
  speak: (visemes: readonly string[], milliseconds: number) => void;
  /** The names of the morph targets that it found, or made itself. */
  targets: () => string[];
  /** How far a morph target goes now. */
  influence: (name: string) => number;
  /** Where joints are in the world, all at one instant: it never stands still. */
  joints: (...names: string[]) => Place[];
  /** Stand still once a morph target goes so far, and say how many pixels it changes then, and how many of those are above the eyes. */
  shaped: (name: string, least: number) => Promise<{ pixels: number; above: number }>;
}

export interface VrmPage {
  expressions: () => string[];
  /** How far an expression moves a vertex at most, and between which heights it moves any. */
  express: (name: string) => { most: number; heights: [number, number] };
  /** Look so many degrees to the avatar's left and upwards, and say by how many the left eye turned. */
  lookAside: (left: number, up: number) => [number, number];
  joint: (bone: VRMHumanBoneName) => Place;
  /** Turn a bone as programs for VRM do: as if its axes were the world's. */
  turn: (bone: VRMHumanBoneName, axis: 'x' | 'y' | 'z', degrees: number) => void;
}

export interface CompressedPage {
  /** What the compressed avatar has; and how far its vertices are from the plain one's at most: at rest, with an expression, and
   * half a second into a clip. */
  compare: (
    target: string,
    clip: string,
  ) => { triangles: number; targets: string[]; rest: number; opened: number; waving: number };
}

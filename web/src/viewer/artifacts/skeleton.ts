/** What a job says of the people that it found in its picture, and of the camera that saw them (skeleton.json). */

import { type Job, readArtifact } from '../../api';

/** The joints that a job found in its picture, or was given, in pixels of the picture. */
export interface Skeleton {
  size: [number, number];
  joints: Record<string, { place: [number, number]; confidence: number }>;
  /** From where the picture was taken; earlier versions did not say it. */
  camera?: PictureCamera;
  /** Who character.glb, character-2.glb and so on are, in their order; earlier versions did not say it. */
  woken?: CharacterPlace[];
}

/** The picture's camera in the character's world: y up, ground at 0, looking along -z. */
export interface PictureCamera {
  /** Metres. */
  eye: [number, number, number];
  /** Pixels of the picture. */
  focal: number;
  centre: [number, number];
  size: [width: number, height: number];
}

/** PersonChoice a character is, and where. */
export interface CharacterPlace {
  /** Which of the people found, counted from 0. */
  person: number;
  /** Where the origin of their world is in that of the first, in metres. */
  place: [x: number, y: number, z: number];
}

/** Null where the job left none. */
export const getSkeleton = (of: Pick<Job, 'artifacts'>, signal?: AbortSignal): Promise<Skeleton | null> =>
  readArtifact(of, 'skeleton.json', signal);

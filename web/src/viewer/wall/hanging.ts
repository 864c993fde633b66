/** Where a picture hangs, so that from its camera's eye all in it is where it was. */

import type { PictureCamera } from '../artifacts/skeleton';

/**
 * Metres behind the person's middle. The film's wall is further off, where the floor of the picture looks right under the
 * feet; a picture that hangs there would be larger than life.
 */
const BEHIND = 0.4;
/** Metres between the floor of the room and the picture, its frame among them. */
const ABOVE_FLOOR = 0.32;

/** All in metres of a room whose floor is at y = 0. */
export interface Hanging {
  eye: [x: number, y: number, z: number];
  /** The z of the picture. */
  plane: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
  /** How far the ground in the picture is above the floor of the room. */
  lift: number;
}

export function hang({ eye: [x, y, z], focal, centre: [cx, cy], size: [width, height] }: PictureCamera): Hanging {
  const plane = -BEHIND;
  const metres = (z - plane) / focal; // a pixel of the picture there
  // the centre of the first pixel is at 0: the picture begins half a pixel before it
  const bottom = y - (height - 0.5 - cy) * metres;
  const lift = Math.max(0, ABOVE_FLOOR - bottom);
  return {
    eye: [x, y + lift, z],
    plane,
    left: x - (cx + 0.5) * metres,
    right: x + (width - 0.5 - cx) * metres,
    top: y + (cy + 0.5) * metres + lift,
    bottom: bottom + lift,
    lift,
  };
}

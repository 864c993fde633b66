/** What a revision asks for. */

import type { PortraitChanges, PortraitOptions } from '../api';
import { type Choices, parts, usual } from '../components/choices';

export interface Wishes extends Choices {
  /** The performer's frame that shows what the picture shows; null where it is to be found. */
  neutral: number | null;
  /** Which face of the picture, counted from the largest. */
  face: number;
  crop: NonNullable<PortraitOptions['crop']>;
  size: [number, number] | null;
  /** 68 placed points in pixels of the picture; null where they are to be found. */
  landmarks: [number, number][] | null;
}

/** The options of a revision: null where the default is wanted, whatever the job had. */
export function revisionOptions(wishes: Wishes): PortraitChanges {
  return {
    strength: wishes.strength === usual.strength ? null : wishes.strength,
    follow: wishes.follow.length === parts.length ? null : [...wishes.follow],
    sound: wishes.sound || null,
    neutral_frame: wishes.neutral,
    face_index: wishes.face || null,
    crop: wishes.crop === 'none' ? null : wishes.crop,
    size: wishes.size,
    landmarks: wishes.landmarks,
  };
}

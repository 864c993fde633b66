/** What a revision asks for. */

import type { PortraitChanges, PortraitOptions } from '../types';
import { type Choices, choicesOf, parts, defaults } from '../choices';
import type { Format, Size } from '../../../studio/video_fields';

export interface RevisionDraft extends Choices {
  /** The performer's frame that shows what the picture shows; null where it is to be found. */
  neutral: number | null;
  /** Seconds of the performance from which and up to which it is used; null for its own beginning and end. */
  trim: readonly [start: number | null, end: number | null];
  /** Which face of the performance, counted from the largest. */
  driverFace: number;
  /** Whether the head is turned in 3D. */
  solid: boolean;
  /** Which face of the picture, counted from the largest. */
  face: number;
  crop: NonNullable<PortraitOptions['crop']>;
  size: Size;
  /** Frames a second; null for the performance's own. */
  rate: number | null;
  format: Format;
  /** 68 placed points in pixels of the picture; null where they are to be found. */
  landmarks: [number, number][] | null;
}

/** What a job was made with. */
export const draftOf = (made: PortraitOptions): RevisionDraft => ({
  ...choicesOf(made),
  neutral: made.neutral_frame ?? null,
  trim: made.trim ?? [null, null],
  driverFace: made.driver_face_index ?? 0,
  solid: made.head_3d ?? true,
  face: made.face_index ?? 0,
  crop: made.crop ?? 'none',
  size: made.size ?? null,
  rate: made.fps ?? null,
  format: made.format ?? 'mp4',
  landmarks: made.landmarks ?? null,
});

/** Whether the same is seen of the performance, by the same numbers: what makes a frame of it the calm one. */
export const sameFrames = (one: RevisionDraft, other: RevisionDraft): boolean =>
  one.driverFace === other.driverFace && one.rate === other.rate && one.trim.every((second, index) => second === other.trim[index]);

/** The options of a revision: null where the default is wanted, whatever the job had. */
export function revisionOptions(draft: RevisionDraft): PortraitChanges {
  return {
    strength: draft.strength === defaults.strength ? null : draft.strength,
    follow: draft.follow.length === parts.length ? null : [...draft.follow],
    sound: draft.sound || null,
    loop: draft.loop || null,
    neutral_frame: draft.neutral,
    trim: draft.trim[1] === null ? null : [draft.trim[0] ?? 0, draft.trim[1]],
    driver_face_index: draft.driverFace || null,
    head_3d: draft.solid ? null : false,
    face_index: draft.face || null,
    crop: draft.crop === 'none' ? null : draft.crop,
    size: draft.size,
    fps: draft.rate,
    format: draft.format === 'mp4' ? null : draft.format,
    landmarks: draft.landmarks,
  };
}

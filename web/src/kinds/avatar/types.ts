/** What an avatar takes, and what it leaves that is read here. */

import type { Job, Report, Schemas } from '../../api';
import type { MotionName } from '../../motion/types';
import type { PictureSheet } from '../../widgets/sheet_cell';

export type AvatarOptions = Partial<Schemas['AvatarOptions']>;

export const avatarOptions = (of: Job): AvatarOptions => of.options as AvatarOptions;

/** What moves an avatar where nothing else is said. */
export const USUAL_MOTION: MotionName = 'idle';

/** The clips that an avatar is made of. */
export const clipNames = ['body', 'head'] as const;
export type ClipName = (typeof clipNames)[number];

/** The frames that were chosen of a clip, and where they are on its sheet (frames.json). */
export interface FrameSheet {
  /** The name of the artifact. */
  sheet: string;
  columns: number;
  /** Width and height of each on the sheet, and of the clip itself, in pixels. */
  cell: [width: number, height: number];
  size: [width: number, height: number];
  /** Their numbers in the clip. */
  frames: readonly number[];
  seconds: readonly number[];
}

export const picturesOf = ({ columns, cell, frames }: FrameSheet): PictureSheet => ({ columns, cell, count: frames.length });

export type FrameSheets = { readonly [Clip in ClipName]?: FrameSheet };

/** Where the camera stood in the frames of a clip (cameras.json); only what this page reads. */
export interface CapturedCamera {
  size: [width: number, height: number];
  /** K, R and t in rows: a point p, metres, is seen at K (R p + t). */
  intrinsics: readonly (readonly number[])[];
  rotation: readonly (readonly number[])[];
  translation: readonly number[];
}

export type CapturedCameras = { readonly [Clip in ClipName]?: readonly CapturedCamera[] };

export type AvatarReport = Report;

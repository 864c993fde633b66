/** What a portrait takes, and what it leaves that is read here. */

import { type Frame, type Job, readArtifact, type Report, type Schemas } from '../../api';

export type PortraitOptions = Partial<Schemas['PortraitOptions']>;
export type Part = NonNullable<PortraitOptions['follow']>[number];

/** A portrait's options where null takes one back to its default. */
export type PortraitChanges = { [Name in keyof PortraitOptions]: PortraitOptions[Name] | null };

/** The 68 landmarks that a job found in its picture, in pixels of the picture (landmarks.json). */
export interface Landmarks {
  size: [number, number];
  landmarks: [number, number][];
}

export const portraitOptions = (of: Job): PortraitOptions => of.options as PortraitOptions;

/** Null where the job left none. */
export const getLandmarks = (of: Job, signal?: AbortSignal): Promise<Landmarks | null> =>
  readArtifact(of, 'landmarks.json', signal);

export type PortraitReport = Report<{
  fps: number;
  frames: number;
  neutral_frame: number;
  /** The driver that the job took where it was asked to choose. */
  driver_chosen?: string | null;
  /** The faces found in the picture, the largest first. */
  faces: Frame[];
  /** The faces found in the performance, the largest first; earlier versions did not say it. */
  driver_faces?: Frame[];
}>;

/** The boxes of the faces that a failed job has found, to choose another from. */
export const foundFaces = (of: Job): Frame[] => (of.error?.found as { faces?: Frame[] } | undefined)?.faces ?? [];

/** From where the picture of a character was taken: what a wall needs to hang it there. */

import type { Job } from '../api';

/** The picture's camera in the character's world: y up, ground at 0, looking along -z. */
export interface PictureCamera {
  /** Metres. */
  eye: [number, number, number];
  /** Pixels of the picture. */
  focal: number;
  centre: [number, number];
  size: [width: number, height: number];
}

export interface PictureView {
  camera: PictureCamera;
  /** The picture without the person. */
  background: string;
}

/** Null where the job does not say it: those of earlier versions. */
export async function getPictureView(job: Job, signal: AbortSignal): Promise<PictureView | null> {
  const { 'skeleton.json': skeleton, 'background.png': background } = job.artifacts;
  if (!skeleton || !background) return null;
  const response = await fetch(skeleton.url, { signal });
  if (!response.ok) return null;
  const { camera } = (await response.json()) as { camera?: PictureCamera };
  return camera ? { camera, background: background.url } : null;
}

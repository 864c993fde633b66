/** From where the picture of a character was taken: what a wall needs to hang it there. */

import type { PictureCamera, Skeleton } from './skeleton';
import type { HasArtifacts } from './people';

export interface PictureView {
  camera: PictureCamera;
  /** The picture without the person. */
  background: string;
}

/** Whether a job may say it; those of earlier versions did not. */
export const mayHaveView = ({ artifacts }: HasArtifacts): boolean => 'skeleton.json' in artifacts && 'background.png' in artifacts;

/** Null where the job does not say it. */
export function viewOf({ artifacts }: HasArtifacts, skeleton: Skeleton | null): PictureView | null {
  const background = artifacts['background.png']?.url;
  return skeleton?.camera && background ? { camera: skeleton.camera, background } : null;
}

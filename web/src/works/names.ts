/** What a work is called, what it does, and where its picture is. */

import type { Job } from '../api';
import { kindOf } from '../kinds';
import { fileUrl, isFileId } from '../names';
import { plain } from '../strings';

/** The picture's name: this page leaves it in the metadata; other clients may not. */
export const pictureName = (job: Job): string => kindOf(job.kind).pictureName(job) ?? plain(job.kind);

/** Characters of a title, at most. */
export const MAX_TITLE_CHARACTERS = 200;

/** What a work is called: as its user has titled it, or else like its picture. */
export const workName = (job: Job): string => job.title ?? pictureName(job);

/** What the picture acts out or does; null when a client sent a file and did not say. */
export const performanceName = (job: Job): string | null => kindOf(job.kind).performance(job);

/** Where the picture itself is, as it was sent. */
export function pictureUrl(job: Job): string | null {
  const { pictureInput } = kindOf(job.kind);
  const picture = pictureInput === null ? Object.values(job.inputs).flat().find(isFileId) : job.inputs[pictureInput];
  return isFileId(picture) ? fileUrl(picture) : null;
}

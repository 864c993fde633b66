/** What a work is called, and where its picture is. */

import type { Job } from '../api';
import type { Kind } from '../kind/kind';
import { plain } from '../language/strings';
import { fileUrl, isFileId } from './inputs';

/** The picture's name: this page leaves it in the metadata; other clients may not. */
export const pictureName = (job: Job, kind: Kind): string => kind.pictureName(job) ?? plain(job.kind);

/** Characters of a title, at most. */
export const MAX_TITLE_CHARACTERS = 200;

/** What a work is called: as its user has titled it, or else like its picture. */
export const workName = (job: Job, kind: Kind): string => job.title ?? pictureName(job, kind);

/** Where the picture itself is, as it was sent. */
export function pictureUrl(job: Job, { pictureInput }: Kind): string | null {
  const given = pictureInput === null ? Object.values(job.inputs) : [job.inputs[pictureInput]];
  const picture = given.flat().find(isFileId);
  return picture === undefined ? null : fileUrl(picture);
}

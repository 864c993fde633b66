/** What a job that was not made asks for: another picture, something changed, or only another try. */

import type { Job } from '../api';

/** Codes of what the picture itself is in the way of. */
const OF_PICTURE =
  /^(no_face|face_too_(turned|small)|mouth_too_open|no_person|not_full_body|person_(too_small|lying)|not_an_image|image_.+)$/;

/** Whether the advice is to choose another picture. */
export const wantsPicture = (job: Job): boolean => job.status === 'failed' && OF_PICTURE.test(job.error?.code ?? '');

/** Whether the same may well succeed without any change: it was canceled, or failed for no fault of what was sent. */
export const mayRepeat = (job: Job): boolean =>
  job.status === 'canceled' || (job.status === 'failed' && !wantsPicture(job) && !job.error?.correctable?.length);

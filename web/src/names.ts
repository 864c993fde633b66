/** What a job's portrait and performance are called, and where they are. */

import type { Job } from './api';
import { plain } from './strings';

const fileId = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/;

const text = (value: unknown): string | null => (typeof value === 'string' && value !== '' ? value : null);

/** The portrait's name: this page leaves it in the metadata; other clients may not. */
export const portraitName = (job: Job): string => text(job.metadata.portrait) ?? plain(job.kind);

/** The performance's name; null when a client sent a video and did not say. */
export function performanceName(job: Job): string | null {
  const driver = text(job.inputs.driver);
  return text(job.metadata.performance) ?? (driver && !fileId.test(driver) && !isUrl(driver) ? plain(driver) : null);
}

/** Where the portrait itself is, as it was sent. */
export function portraitUrl(job: Job): string | null {
  const image = text(job.inputs.image);
  return image && fileId.test(image) ? `/v1/files/${image}/content` : null;
}

/** Where the performance's video plays from: an uploaded file, or a named driver. */
export function performanceUrl(job: Job): string | null {
  const driver = text(job.inputs.driver);
  if (!driver || driver === 'auto') return null;
  if (isUrl(driver)) return null; // another site's video: not loaded behind the user's back
  if (fileId.test(driver)) return `/v1/files/${driver}/content`;
  return `/v1/drivers/${encodeURIComponent(driver)}/video`;
}

const isUrl = (value: string): boolean => /^https?:/.test(value);

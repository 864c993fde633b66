/** What a job's portrait and performance are called, and where they are. */

import { characterOptions, type Job, type MotionName } from './api';
import { plain, strings } from './strings';

/** What a job names to be driven by a moment alone. */
export const momentName = (driver: string, moment: string): string => `${driver}/${moment}`;

/** Whether a job that names this is driven by this driver, or by a moment of it. */
export const ofDriver = (named: string, driver: string): boolean => named === driver || named.startsWith(`${driver}/`);

/** A driver's name made of a file's: what a name cannot have is a dash; another than those that are taken. */
export function driverName(file: string, taken: readonly string[]): string {
  const wanted = file.toLowerCase().replace(/[^a-z0-9_]+/g, '-').replace(/^[-_]+|-+$/g, '').slice(0, 50) || 'driver';
  let name = wanted;
  for (let number = 2; taken.includes(name); number++) name = `${wanted}-${number}`;
  return name;
}

const fileIdForm = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/;

/** Whether an input is a file that was uploaded. */
export const isFileId = (value: unknown): value is string => typeof value === 'string' && fileIdForm.test(value);

/** The name under which the service chooses a driver itself. */
export const AUTO = 'auto';

const text = (value: unknown): string | null => (typeof value === 'string' && value !== '' ? value : null);

/** The picture's name: this page leaves it in the metadata; other clients may not. */
export const pictureName = (job: Job): string =>
  text(job.metadata.portrait) ?? text(job.metadata.photo) ?? plain(job.kind);

/** Characters of a title, at most. */
export const LONGEST_TITLE = 200;

/** What a work is called: as its user has titled it, or else like its picture. */
export const workName = (job: Job): string => job.title ?? pictureName(job);

/** The name under which something is kept, of what was typed for it: the service says what else is wrong with it. */
export const keptName = (typed: string): string => typed.trim().toLowerCase().replace(/\s+/g, '-');

/** A built-in motion in the page's language. */
export const motionName = (motion: MotionName): string => strings.character.motions[motion];

/** The clip into which characters step where nothing else is said. */
export const USUAL_MOTION: MotionName = 'walk';

/** What the picture acts out or does; null when a client sent a file and did not say. */
export function performanceName(job: Job): string | null {
  if (job.kind === 'character') {
    if (text(job.inputs.motion)) return text(job.metadata.motion);
    return motionName(characterOptions(job).motion ?? USUAL_MOTION);
  }
  const driver = text(job.inputs.driver);
  return text(job.metadata.performance) ?? (driver && !isFileId(driver) && !isUrl(driver) ? plain(driver) : null);
}

/** Where the picture itself is, as it was sent. */
export function pictureUrl(job: Job): string | null {
  const image = text(job.inputs.image) ?? text(job.inputs.photo);
  return image && isFileId(image) ? `/v1/files/${image}/content` : null;
}

/** Where the performance's video plays from: an uploaded file, a named driver, or the one that the job has chosen. */
export function performanceUrl(job: Job, chosen?: string | null): string | null {
  const driver = text(job.inputs.driver) === AUTO ? text(chosen) : text(job.inputs.driver);
  if (!driver) return null;
  const [name = ''] = driver.split('/'); // of a moment, the whole video: the job's trim says which part
  if (isUrl(driver)) return null; // another site's video: not loaded behind the user's back
  if (isFileId(driver)) return `/v1/files/${driver}/content`;
  return `/v1/drivers/${encodeURIComponent(name)}/video`;
}

export const isUrl = (value: string): boolean => /^https?:/.test(value);

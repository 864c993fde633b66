/** What drives a face: the names of performances and their moments, and where they play from. */

import type { Job } from '../api';
import { fileUrl, isFileId, isUrl, textOf } from '../works/inputs';

/** The name under which the service chooses a driver itself. */
export const AUTO = 'auto';

/** Characters of a driver's name that is made of a file's, at most. */
const MAX_NAME_CHARACTERS = 50;

/** What a job names to be driven by a moment alone. */
export const momentName = (driver: string, moment: string): string => `${driver}/${moment}`;

/** Whether a job that names this is driven by this driver, or by a moment of it. */
export const ofDriver = (named: string, driver: string): boolean => named === driver || named.startsWith(`${driver}/`);

/** A driver's name made of a file's: what a name cannot have is a dash; another than those that are taken. */
export function driverName(file: string, taken: readonly string[]): string {
  const allowed = file.toLowerCase().replace(/[^a-z0-9_]+/g, '-').replace(/^[-_]+|-+$/g, '');
  const wanted = allowed.slice(0, MAX_NAME_CHARACTERS) || 'driver';
  let name = wanted;
  for (let number = 2; taken.includes(name); number++) name = `${wanted}-${number}`;
  return name;
}

/** Where the performance's video plays from: an uploaded file, a named driver, or the one that the job has chosen. */
export function performanceUrl(job: Job, chosen?: string | null): string | null {
  const driver = textOf(job.inputs.driver) === AUTO ? textOf(chosen) : textOf(job.inputs.driver);
  if (!driver) return null;
  const [name = ''] = driver.split('/'); // of a moment, the whole video: the job's trim says which part
  if (isUrl(driver)) return null; // another site's video: not loaded behind the user's back
  if (isFileId(driver)) return fileUrl(driver);
  return `/v1/drivers/${encodeURIComponent(name)}/video`;
}

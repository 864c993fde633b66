/** What a finished run says about itself (report.json). */

import { type Job, readArtifact } from './jobs';

/** x, y, width and height in pixels of the picture. */
export type Frame = [x: number, y: number, width: number, height: number];

/** Only what this page reads; what is said of the inputs differs from kind to kind. */
export interface Report<Inputs = unknown> {
  warnings: { code: string; message: string }[];
  inputs: Inputs;
}

/** Null where the job left none. */
export const getReport = <Kinds extends Report>(of: Job, signal?: AbortSignal): Promise<Kinds | null> =>
  readArtifact(of, 'report.json', signal);

/**
 * Jobs that several files of tests look at, made once a run. The service of each file begins with a copy of the folder that
 * they lie in (`own_service`), so that none of them makes what another has made, nor finds what another left.
 */

import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { TestProject } from 'vitest/node';
import { ended, LONG, orderCharacter, orderPortrait } from './jobs';
import { faceless, portrait, samplePerson } from './media';
import { serve } from './service';

declare module 'vitest' {
  export interface ProvidedContext {
    finished: {
      folder: string;
      jobs: Finished;
      /** The picture of the finished character: the project's own, of one person. */
      somebody: string;
    };
  }
}

export interface Finished {
  /** The portrait of `media`, acting out “happy”. */
  portrait: string;
  /** A portrait that failed: nobody is in the picture. */
  noFace: string;
  /** The person of the project's own picture, in a small video of two seconds. */
  character: string;
  /** A character that failed likewise. */
  noPerson: string;
}

/** Milliseconds that the engine is compiled for where that was not done before; the first jobs wait for it. */
const COMPILING = 1_200_000;

export default async function setup(project: TestProject): Promise<() => Promise<void>> {
  const { address, data, stop, end } = await serve({ GALATEA_CONCURRENCY: '2' });
  const pictures = mkdtempSync(join(tmpdir(), 'galatea-pictures-'));
  const somebody = join(pictures, 'somebody.png');
  const forget = async (): Promise<void> => {
    await end();
    rmSync(pictures, { recursive: true, force: true });
  };
  try {
    samplePerson(somebody);
    // the two that are looked at most come last: what is recent is shown first
    const jobs: Finished = {
      noFace: await orderPortrait(address, faceless, 'happy'),
      noPerson: await orderCharacter(address, faceless, { seconds: 1 }),
      portrait: await orderPortrait(address, portrait, 'happy'),
      character: await orderCharacter(address, somebody, { seconds: 2, size: [240, 320] }),
    };
    await Promise.all([
      ...[jobs.character, jobs.portrait].map((id) => ended(address, id, 'succeeded', COMPILING + LONG)),
      ...[jobs.noFace, jobs.noPerson].map((id) => ended(address, id, 'failed', COMPILING + LONG)),
    ]);
    await stop();
    project.provide('finished', { folder: data, jobs, somebody });
  } catch (error) {
    await forget();
    throw error;
  }
  return forget;
}

/**
 * Jobs that several files of tests look at, made once a run. The service of each file begins with a copy of the folder that
 * they lie in (`own_service`), so that none of them makes what another has made, nor finds what another left.
 */

import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { TestProject } from 'vitest/node';
import { ended, LIGHT, LONG, SMALL, orderCharacter, orderPortrait } from './jobs';
import { faceless, portrait, samplePerson } from './media';
import { serve } from './service';

declare module 'vitest' {
  export interface ProvidedContext {
    finished: {
      folder: string;
      jobs: Finished;
      /** The picture of the finished character: the project's own, of one person. */
      somebody: string;
      /** The file of what the reactive portrait left for a web page: profile.zip. */
      profile: string;
    };
  }
}

export interface Finished {
  /** The portrait of `media`, acting out “happy”. */
  portrait: string;
  /** A portrait that failed: nobody is in the picture. */
  noFace: string;
  /** The person of the project's own picture, in a small video of a second. */
  character: string;
  /** A character that failed likewise. */
  noPerson: string;
  /** The portrait of `media`, reactive: it can be happy and surprised. */
  reactive: string;
}

/** Milliseconds that the engine is compiled for where that was not done before; the first jobs wait for it. */
const COMPILING = 1_200_000;

export default async function setup(project: TestProject): Promise<() => Promise<void>> {
  const { address, data, stop, end } = await serve({ GALATEA_CONCURRENCY: '2', GALATEA_WORKER_KINDS: 'portrait,character' });
  const pictures = mkdtempSync(join(tmpdir(), 'galatea-pictures-'));
  const [somebody, profile] = ['somebody.png', 'profile.zip'].map((name) => join(pictures, name)) as [string, string];
  const forget = async (): Promise<void> => {
    await end();
    rmSync(pictures, { recursive: true, force: true });
  };
  try {
    samplePerson(somebody);
    // the two that are looked at most come last: what is recent is shown first
    const jobs: Finished = {
      noFace: await orderPortrait(address, faceless, 'wink'),
      noPerson: await orderCharacter(address, faceless, { seconds: 1 }),
      reactive: await orderPortrait(address, portrait, null, { reactive: ['happy', 'surprise'], ...SMALL }),
      portrait: await orderPortrait(address, portrait, 'happy', SMALL),
      character: await orderCharacter(address, somebody, LIGHT),
    };
    await Promise.all([
      ...[jobs.character, jobs.portrait, jobs.reactive].map((id) => ended(address, id, 'succeeded', COMPILING + LONG)),
      ...[jobs.noFace, jobs.noPerson].map((id) => ended(address, id, 'failed', COMPILING + LONG)),
    ]);
    const zip = await fetch(`${address}/v1/jobs/${jobs.reactive}/artifacts/profile.zip`);
    writeFileSync(profile, Buffer.from(await zip.arrayBuffer()));
    await stop();
    project.provide('finished', { folder: data, jobs, somebody, profile });
  } catch (error) {
    await forget();
    throw error;
  }
  return forget;
}

/** No file of tests finds what another left: each has a service that began with the finished jobs, and with nothing else. */

import './nobody_works';
import { existsSync, readFileSync } from 'node:fs';
import { expect, inject, it } from 'vitest';
import { inPython } from './media';
import { address, finished } from './own_service';
import { serve } from './service';

const video = inPython('from engine.performances import video; print(video("wink"))');

/** What a service has: its jobs, and how many videos, motions, webhooks and keys were given to it. */
async function holdings(at: string): Promise<[jobs: string[], given: number[]]> {
  const items = async (path: string): Promise<{ id: string; source?: string }[]> =>
    ((await (await fetch(at + path)).json()) as { items: { id: string; source?: string }[] }).items;
  const given = await Promise.all(['/v1/drivers', '/v1/motions', '/v1/webhooks', '/v1/keys'].map(items));
  return [(await items('/v1/jobs')).map(({ id }) => id).sort(), given.map((all) => all.filter(({ source }) => source !== 'built-in').length)];
}

it('begins as the others do, and keeps for itself what is left in it', async () => {
  const fresh = [Object.values(finished).sort(), [0, 0, 0, 0]];
  expect(await holdings(address)).toEqual(fresh);
  const form = new FormData();
  form.append('name', 'left-behind');
  form.append('file', new File([readFileSync(video)], 'wink.mp4'));
  expect((await fetch(`${address}/v1/drivers`, { method: 'POST', body: form })).ok).toBe(true);
  expect((await holdings(address))[1]).toEqual([1, 0, 0, 0]);

  const next = await serve({}, inject('finished').folder);
  try {
    expect(await holdings(next.address)).toEqual(fresh);
    const film = await fetch(`${next.address}/v1/jobs/${finished.portrait}/artifacts/animation.mp4`);
    expect([film.status, film.headers.get('content-type')]).toEqual([200, 'video/mp4']);
  } finally {
    await next.end();
  }
  expect(existsSync(next.data)).toBe(false);
  await expect(fetch(next.address)).rejects.toThrow();
});

/** What was changed from one version of a work to the next, in words. */

import type { Job } from '../api';
import type { Kind } from '../kind/kind';
import { plain, strings } from '../language/strings';

const words = strings.history;

/** Names of the inputs and options by which a version differs from the one that it revises; those with words first. */
function changed(job: Job, before: Job, known: readonly string[]): string[] {
  const now = { ...job.options, ...job.inputs };
  const then = { ...before.options, ...before.inputs };
  const names = new Set([...known, ...Object.keys(now), ...Object.keys(then)]);
  return [...names].filter((name) => JSON.stringify(now[name] ?? null) !== JSON.stringify(then[name] ?? null));
}

/** Each change once, in the order of their words; empty where nothing was changed. */
export function differences(job: Job, before: Job, kind: Kind): string[] {
  const told = changed(job, before, Object.keys(kind.differences)).map((name) => {
    const what = kind.differences[name] ?? plain(name).toLowerCase();
    const value = kind.valueOf(job, name);
    return value === null ? what : words.now(what, value);
  });
  return [...new Set(told)];
}

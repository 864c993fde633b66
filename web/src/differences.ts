/** What was changed from one version of a work to the next, in words. */

import { characterOptions, type Job, portraitOptions } from './api';
import { motionName, performanceName, USUAL_MOTION } from './names';
import { plain, strings } from './strings';

const words = strings.history;

/** Names of the inputs and options by which a version differs from the one that it revises. */
function changed(job: Job, before: Job): string[] {
  const now = { ...job.options, ...job.inputs };
  const then = { ...before.options, ...before.inputs };
  const names = new Set([...Object.keys(strings.differences), ...Object.keys(now), ...Object.keys(then)]);
  return [...names].filter((name) => JSON.stringify(now[name] ?? null) !== JSON.stringify(then[name] ?? null));
}

/** What a version has that can be told in a word; null of others. */
function valueOf(job: Job, name: string): string | null {
  switch (name) {
    case 'strength':
      return `${Math.round((portraitOptions(job).strength ?? 1) * 100)}%`;
    case 'driver':
      return performanceName(job);
    case 'motion':
      return job.inputs.motion ? null : motionName(characterOptions(job).motion ?? USUAL_MOTION);
    default:
      return null;
  }
}

/** Each change once, in the order of their words; empty where nothing was changed. */
export function differences(job: Job, before: Job): string[] {
  const told = changed(job, before).map((name) => {
    const what = (strings.differences as Record<string, string>)[name] ?? plain(name).toLowerCase();
    const value = valueOf(job, name);
    return value === null ? what : words.now(what, value);
  });
  return [...new Set(told)];
}

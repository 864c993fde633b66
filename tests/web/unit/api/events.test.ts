import { type Change, follow, nothing } from '@web/api/events';
import { describe, expect, it } from 'vitest';
import { aJob } from '../job';

const after = (...changes: Change[]) => changes.reduce(follow, nothing);
const progress = (stage: string, fraction: number): Change => ({
  type: 'progress',
  progress: { stage, fraction, message: '', eta_seconds: 3 },
});

describe('following a job', () => {
  it('keeps the stages in the order in which they were first seen', () => {
    const state = after(
      { type: 'job', job: aJob() },
      progress('target', 0.1),
      progress('driver', 0.2),
      progress('driver', 0.4),
      progress('target', 0.5),
    );
    expect(state.stages).toEqual(['target', 'driver']);
    expect(state.job?.progress).toMatchObject({ stage: 'target', fraction: 0.5 });
  });

  it('keeps the order of the work where the service tells it, whenever the page was loaded', () => {
    const whole = aJob({ progress: { stage: 'render', fraction: 0.6, message: '', stages: ['target', 'driver', 'render'] } });
    const state = after({ type: 'job', job: whole }, progress('target', 0.1), progress('driver', 0.2), progress('render', 0.7));
    expect(state.stages).toEqual(['target', 'driver', 'render']);
  });

  it('is not moved by old progress once the job is finished', () => {
    const done = aJob({ status: 'succeeded', progress: { stage: null, fraction: 1, message: '', eta_seconds: null } });
    const state = after({ type: 'job', job: done }, progress('target', 0.1));
    expect(state.job).toBe(done);
  });

  it('forgets an interruption as soon as anything comes through', () => {
    const broken = after({ type: 'job', job: aJob() }, { type: 'interrupted' });
    expect(broken.interrupted).toBe(true);
    expect(follow(broken, progress('target', 0.1)).interrupted).toBe(false);
    expect(follow(broken, { type: 'job', job: aJob() }).interrupted).toBe(false);
  });
});

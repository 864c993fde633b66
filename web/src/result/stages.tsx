/** How far a job is: a bar, the time left, and the stages in plain words. */

import type { Job } from '../api';
import { duration, percent } from '../language/format';
import { strings } from '../language/strings';
import { useKinds } from '../kind/kinds';
import { stageName } from '../kind/stage_names';

const words = strings.job;

/** The stage of a job that waits for the engine to be compiled, which the service does once. */
const prepareEngine = 'prepare_engine';

const place = ({ queue_position: at }: Job): string => (at === null ? '' : at === 1 ? words.next : words.place(at));

export function Stages({ job, stages }: { job: Job; stages: string[] }) {
  const kinds = useKinds();
  const queued = job.status === 'queued';
  const { fraction = 0, eta_seconds: eta = null, stage: current } = job.progress;
  const preparing = queued && current === prepareEngine;
  const headline = queued && !preparing ? words.queued : current ? stageName(kinds, job.kind, current) : words.starting;

  return (
    <div class="stages">
      {/* Spoken when the stage changes, not with every percent. */}
      <p class="headline" aria-live="polite">
        {headline}
      </p>
      <progress aria-label={words.progress} max="1" value={queued ? undefined : fraction} />
      <p class="figures">
        <span>{preparing ? words.preparing : queued ? place(job) : words.done(percent(fraction))}</span>
        <span>{eta !== null && !queued ? words.remaining(duration(eta)) : ''}</span>
      </p>
      {stages.length > 0 && (
        <ol aria-label={words.stages}>
          {stages.map((stage) => (
            <li key={stage} class={stage === current ? 'current' : 'done'} aria-current={stage === current && 'step'}>
              {stageName(kinds, job.kind, stage)}
              <span class="visually-hidden"> {stage === current ? words.stageRunning : words.stageDone}</span>
            </li>
          ))}
        </ol>
      )}
    </div>
  );
}

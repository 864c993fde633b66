/** The same portrait in another mood, at one click. */

import { useRef } from 'preact/hooks';
import { createJob, type Driver, type Job, listDrivers } from '../../api';
import { type PortraitOptions, portraitOptions } from './types';
import { randomKey } from '../../api/idempotency';
import { useDoing, useLoaded } from '../../api/loading';
import { isFileId } from '../../works/inputs';
import { useKind } from '../../kind/kinds';
import { pictureName } from '../../works/names';
import { jobLink } from '../../route';
import { words as portraitWords } from './words';
import { labelOf } from './performance_card';
import { ProblemAlert } from '../../widgets/problem_alert';

/** What belongs to the picture and the video, and so goes along; the rest is of the performance. */
const KEPT = ['size', 'fps', 'format', 'face_index', 'strength', 'follow', 'head_3d', 'crop', 'loop', 'landmarks'] as const;

export const carriedOver = (options: PortraitOptions): PortraitOptions =>
  Object.fromEntries(KEPT.filter((name) => name in options).map((name) => [name, options[name]]));

export function OtherMoods({ job }: { job: Job }) {
  const drivers = useLoaded(listDrivers, 'drivers').value ?? [];
  const kind = useKind(job.kind);
  const { doing, problem, attempt } = useDoing();
  const keys = useRef(new Map<string, string>()); // a click that is repeated after a broken line orders nothing twice
  const { image, driver: played } = job.inputs;
  if (!isFileId(image)) return null;
  const offered = drivers.filter((one) => one.source === 'built-in' && one.strength === 'normal' && one.name !== played);
  if (!offered.length) return null;

  const make = (driver: Driver): Promise<void> =>
    attempt(async () => {
      const key = keys.current.get(driver.name) ?? randomKey();
      keys.current.set(driver.name, key);
      const metadata = { portrait: pictureName(job, kind), performance: labelOf(driver) };
      const options = carriedOver(portraitOptions(job));
      const made = await createJob({ kind: 'portrait', inputs: { image, driver: driver.name }, options, metadata }, key);
      location.hash = jobLink(made.id);
    });
  return (
    <section class="moods" aria-labelledby="moods-title">
      <h2 id="moods-title">{portraitWords.result.moods}</h2>
      <div>
        {offered.map((driver) => (
          <button key={driver.name} type="button" class="card" disabled={doing} onClick={() => void make(driver)}>
            {driver.poster && <img src={driver.poster} alt="" loading="lazy" width="128" height="128" />}
            <span>{labelOf(driver)}</span>
          </button>
        ))}
      </div>
      {problem && <ProblemAlert code={problem.code} detail={problem.detail} />}
    </section>
  );
}

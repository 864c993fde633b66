/** One click has the face of a job act out another performance. */

import { useRef } from 'preact/hooks';
import { createJob, type Driver, type JobRequest, listDrivers } from '../api';
import { randomKey } from '../api/idempotency';
import { useDoing, useLoaded } from '../api/loading';
import { jobLink } from '../route';
import { ProblemAlert } from '../widgets/problem_alert';
import { labelOf } from './performance_card';
import './styles/others.css';

interface Props {
  title: string;
  /** Of the job that is ordered. */
  kind: string;
  /** What is played already. */
  played: unknown;
  request: (driver: Driver) => JobRequest;
}

export function OtherPerformances({ title, kind, played, request }: Props) {
  const drivers = useLoaded(listDrivers, 'drivers').value ?? [];
  const { doing, problem, attempt } = useDoing();
  const keys = useRef(new Map<string, string>()); // a click that is repeated after a broken line orders nothing twice
  const offered = drivers.filter((one) => one.source === 'built-in' && one.strength === 'normal' && one.name !== played);
  if (!offered.length) return null;

  const make = (driver: Driver): Promise<void> =>
    attempt(async () => {
      const key = keys.current.get(driver.name) ?? randomKey();
      keys.current.set(driver.name, key);
      const made = await createJob({ kind, ...request(driver) }, key);
      location.hash = jobLink(made.id);
    });
  return (
    <section class="other-performances" aria-labelledby="others-title">
      <h2 id="others-title">{title}</h2>
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

/** An order on its way. When it has arrived, the page turns to its job. */

import { useEffect, useRef, useState } from 'preact/hooks';
import type { Problem } from './api';
import { asProblem } from './loading';
import { type Order, send, type Sending } from './order';
import { usePausing } from './pausing';
import { forgetPending, keepPending, readPending } from './pending';
import { jobLink } from './route';
import { GIVEN_UP } from './upload';

export function useSending() {
  const [step, setStep] = useState<Sending | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const { valve, paused, pause } = usePausing();
  const [waiting, setWaiting] = useState<Order | null>(null);
  const order = useRef<Order | null>(null);
  const stopper = useRef<AbortController | null>(null);

  useEffect(() => {
    void readPending().then((left) => !order.current && setWaiting(left));
    return () => stopper.current?.abort();
  }, []);

  const begin = (next: Order): void => {
    order.current = next;
    stopper.current = new AbortController();
    const { signal } = stopper.current;
    setWaiting(null);
    setProblem(null);
    pause(false);
    setStep({ step: 'ordering' });
    void keepPending(next);
    send(next, setStep, valve, signal).then(
      (job) => {
        setStep(null);
        void forgetPending();
        if (!signal.aborted) location.hash = jobLink(job.id);
      },
      (error: unknown) => {
        setStep(null);
        if (signal.reason === GIVEN_UP) void forgetPending();
        else if (!signal.aborted) setProblem(asProblem(error));
      },
    );
  };

  return {
    step,
    problem,
    paused,
    /** What an earlier page left unfinished. */
    waiting,
    begin,
    pause,
    retry: () => order.current && begin(order.current),
    stop: () => stopper.current?.abort(GIVEN_UP),
    forget: () => {
      setWaiting(null);
      void forgetPending();
    },
  };
}

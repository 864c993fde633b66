/** An order on its way. When it has arrived, the page turns to its job. */

import { useEffect, useRef, useState } from 'preact/hooks';
import type { Problem } from '../api';
import { asProblem } from '../api/loading';
import type { Order } from '../kind/kind';
import { useKinds } from '../kind/kinds';
import { send, type Sending } from './order';
import { usePausing } from './pausing';
import { forgetPending, keepPending, readPending } from './pending';
import { jobLink } from '../route';
import { GIVEN_UP } from '../api/upload';

/** Answers that say that it is too early, too much at once, or that a key is wanted: later the same may be welcome. */
const LATER = [401, 408, 409, 425, 429];

/** Whether the service will not have what was sent, however often it is sent. */
export const isRefusal = ({ status }: Problem): boolean => status >= 400 && status < 500 && !LATER.includes(status);

export function useSending() {
  const kinds = useKinds();
  const [step, setStep] = useState<Sending | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const { pauseControl, paused, pause } = usePausing();
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
    // it is forgotten before the page says how it went: a page that is left then offers nothing to go on with
    send(next, kinds.of(next.kind), setStep, pauseControl, signal).then(
      async (job) => {
        await forgetPending();
        setStep(null);
        if (!signal.aborted) location.hash = jobLink(job.id);
      },
      async (error: unknown) => {
        const problem = asProblem(error);
        if (signal.reason === GIVEN_UP || isRefusal(problem)) await forgetPending();
        setStep(null);
        if (!signal.aborted) setProblem(problem);
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

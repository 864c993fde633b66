/** Something fetched once for a component that shows it. */

import { useEffect, useState } from 'preact/hooks';
import { Problem } from '.';

export type Loading<T> = { value: T | null; problem: Problem | null; reload: () => void };

/** `load` runs when the component appears, and again when `key` changes or `reload` is called. */
export function useLoaded<T>(load: (signal: AbortSignal) => Promise<T>, key: string): Loading<T> {
  const [value, setValue] = useState<T | null>(null);
  const [problem, setProblem] = useState<Problem | null>(null);
  const [turn, setTurn] = useState(0);

  useEffect(() => {
    const stop = new AbortController();
    load(stop.signal).then(
      (loaded) => {
        if (stop.signal.aborted) return;
        setValue(loaded);
        setProblem(null);
      },
      (error: unknown) => {
        if (!stop.signal.aborted) setProblem(asProblem(error));
      },
    );
    return () => stop.abort();
  }, [key, turn]);

  return { value, problem, reload: () => setTurn((t) => t + 1) };
}

export const asProblem = (error: unknown): Problem =>
  error instanceof Problem ? error : new Problem(0, 'unexpected', String(error));

/** Something the visitor asked to be done: whether it is under way, and what went wrong. */
export function useDoing() {
  const [doing, setDoing] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  const attempt = async (what: () => Promise<void>): Promise<void> => {
    setDoing(true);
    setProblem(null);
    try {
      await what();
    } catch (error) {
      setProblem(asProblem(error));
    } finally {
      setDoing(false);
    }
  };
  return { doing, problem, attempt, forget: () => setProblem(null) };
}

/** Makes a video at hand a driver of one's own, so that its emotions are found. It is sent as orders are: with a pause. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { createDriver, listDrivers, type Problem } from '../api';
import { stem } from '../language/format';
import { asProblem } from '../api/loading';
import { driverName } from './drivers';
import type { Sending } from '../sending/order';
import { usePausing } from '../sending/pausing';
import { words } from './words';
import { GIVEN_UP, uploadFile } from '../api/upload';
import { SendingBar } from '../studio/sending_bar';
import { ProblemAlert } from '../widgets/problem_alert';

interface Props {
  file: File;
  /** Something else is being sent: two at once would take the same upload from one another. */
  disabled: boolean;
  onKeeping: (on: boolean) => void;
  /** There is a driver more: of this name, or of no interest any more. */
  onKept: (name: string | null) => void;
}

export function KeepDriver({ file, disabled, onKeeping, onKept }: Props) {
  const [step, setStep] = useState<Sending | null>(null);
  const { pauseControl, paused, pause } = usePausing();
  const [problem, setProblem] = useState<Problem | null>(null);
  const stopper = useRef<AbortController | null>(null);
  const arrived = useRef<string | null>(null);
  useEffect(() => {
    arrived.current = null;
    setProblem(null);
    return () => stopper.current?.abort();
  }, [file]);

  const keep = async (): Promise<void> => {
    const { signal } = (stopper.current = new AbortController());
    setProblem(null);
    pause(false);
    setStep({ step: 'uploading', part: 'video', fraction: 0 });
    onKeeping(true);
    try {
      const progress = (bytes: number): void => setStep({ step: 'uploading', part: 'video', fraction: file.size ? bytes / file.size : 1 });
      arrived.current ??= await uploadFile(file, progress, pauseControl, signal);
      setStep({ step: 'ordering' });
      const taken = (await listDrivers(signal)).map(({ name }) => name); // as they are now: another page may have kept one
      const { name } = await createDriver(driverName(stem(file.name), taken), arrived.current);
      onKept(signal.aborted ? null : name);
    } catch (error) {
      const problem = asProblem(error);
      if (signal.aborted || problem.code === 'unknown_file') arrived.current = null; // what had arrived is gone
      if (!signal.aborted) setProblem(problem);
    } finally {
      setStep(null);
      onKeeping(false);
    }
  };

  return (
    <div class="keep">
      {step ? (
        <SendingBar files={words.files} step={step} paused={paused} onPause={pause} onStop={() => stopper.current?.abort(GIVEN_UP)} />
      ) : (
        <button type="button" class="button" disabled={disabled} onClick={() => void keep()}>
          {words.keep}
        </button>
      )}
      <p class="hint">{words.keepHint}</p>
      {problem && <ProblemAlert code={problem.code} detail={problem.detail} />}
    </div>
  );
}

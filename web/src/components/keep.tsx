/** Makes a video at hand a driver of one's own, so that its emotions are found. It is sent as orders are: with a pause. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { createDriver, type Problem } from '../api';
import { stem } from '../format';
import { asProblem } from '../loading';
import { driverName } from '../names';
import type { Sending } from '../order';
import { strings } from '../strings';
import { GIVEN_UP, uploadFile, Valve } from '../upload';
import { SendingBar } from './sendingbar';
import { Trouble } from './trouble';

interface Props {
  file: File;
  /** The names that drivers have. */
  taken: string[];
  onKept: (name: string) => void;
}

const words = strings.studio;

export function Keep({ file, taken, onKept }: Props) {
  const [step, setStep] = useState<Sending | null>(null);
  const [paused, setPaused] = useState(false);
  const [problem, setProblem] = useState<Problem | null>(null);
  const valve = useRef(new Valve());
  const stopper = useRef<AbortController | null>(null);
  const arrived = useRef<string | null>(null);
  useEffect(() => {
    arrived.current = null;
    return () => stopper.current?.abort();
  }, [file]);

  const pause = (on: boolean): void => {
    setPaused(on);
    valve.current.closed = on;
  };
  const keep = async (): Promise<void> => {
    const { signal } = (stopper.current = new AbortController());
    setProblem(null);
    pause(false);
    setStep({ step: 'video', fraction: 0 });
    try {
      const progress = (bytes: number): void => setStep({ step: 'video', fraction: file.size ? bytes / file.size : 1 });
      arrived.current ??= await uploadFile(file, progress, valve.current, signal);
      setStep({ step: 'ordering' });
      onKept((await createDriver(driverName(stem(file.name), taken), arrived.current)).name);
    } catch (error) {
      if (!signal.aborted) setProblem(asProblem(error));
    } finally {
      setStep(null);
    }
  };

  return (
    <div class="keep">
      {step ? (
        <SendingBar step={step} paused={paused} onPause={pause} onStop={() => stopper.current?.abort(GIVEN_UP)} />
      ) : (
        <button type="button" class="button" onClick={() => void keep()}>
          {words.keep}
        </button>
      )}
      <p class="hint">{words.keepHint}</p>
      {problem && <Trouble code={problem.code} detail={problem.detail} />}
    </div>
  );
}

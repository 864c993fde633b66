/** Sends the files of a revision, if there are any, then the revision; the page turns to its job. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { type Changes, type Job, type Problem, reviseJob } from '../api';
import { asProblem } from '../api/loading';
import { GIVEN_UP, uploadFile } from '../api/upload';
import { jobLink } from '../route';
import type { Sending } from './order';
import { usePausing } from './pausing';

export interface Revision {
  /** What is to be sent, by what it is to the job. */
  files: readonly (readonly [part: string, file: File])[];
  /** What is asked for once the files have arrived, by their ids. */
  changes: (sent: Readonly<Record<string, string>>) => Changes;
}

export function useRevision(job: Job, key: { current: string }, onProblem: (problem: Problem | null) => void) {
  const [busy, setBusy] = useState(false);
  const [step, setStep] = useState<Sending | null>(null);
  const { pauseControl, paused, pause } = usePausing();
  const stopper = useRef<AbortController | null>(null);
  /** What has arrived need not be sent again. */
  const arrived = useRef(new Map<File, string>());
  useEffect(() => () => stopper.current?.abort(), []);

  const upload = async (part: string, file: File, signal: AbortSignal): Promise<string> => {
    const known = arrived.current.get(file);
    if (known) return known;
    const progress = (sent: number): void => setStep({ step: 'uploading', part, fraction: file.size ? sent / file.size : 1 });
    progress(0);
    const id = await uploadFile(file, progress, pauseControl, signal);
    arrived.current.set(file, id);
    return id;
  };
  const send = async ({ files, changes }: Revision): Promise<void> => {
    const { signal } = (stopper.current = new AbortController());
    setBusy(true);
    pause(false);
    onProblem(null);
    try {
      const sent: Record<string, string> = {};
      for (const [part, file] of files) sent[part] = await upload(part, file, signal);
      setStep(null);
      const revised = await reviseJob(job.id, changes(sent), key.current);
      location.hash = jobLink(revised.id);
    } catch (error) {
      if (signal.aborted) arrived.current.clear(); // what had arrived is gone
      else onProblem(asProblem(error));
      setStep(null);
      setBusy(false);
    }
  };
  return {
    busy,
    paused,
    step,
    pause,
    stop: () => stopper.current?.abort(GIVEN_UP),
    send: (revision: Revision) => void send(revision),
  };
}

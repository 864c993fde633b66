/** Sends the files of a revision, if there are any, then the revision; the page turns to its job. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { type Job, type Problem, reviseJob } from '../../../api';
import { asProblem } from '../../../api/loading';
import type { Sending } from '../../../sending/order';
import { usePausing } from '../../../sending/pausing';
import { jobLink } from '../../../route';
import { GIVEN_UP, uploadFile } from '../../../api/upload';
import { changesOf, fileOf, fileParts, isChanged, notesFor, type Sent, type RevisionDraft } from './changes';

type Part = keyof Sent;

export function useRevision(job: Job, key: { current: string }, onProblem: (problem: Problem | null) => void) {
  const [busy, setBusy] = useState(false);
  const [step, setStep] = useState<Sending | null>(null);
  const { pauseControl, paused, pause } = usePausing();
  const stopper = useRef<AbortController | null>(null);
  /** What has arrived need not be sent again. */
  const arrived = useRef(new Map<File, string>());
  useEffect(() => () => stopper.current?.abort(), []);

  const upload = async (part: Part, file: File, signal: AbortSignal): Promise<string> => {
    const known = arrived.current.get(file);
    if (known) return known;
    const progress = (sent: number): void => setStep({ step: 'uploading', part, fraction: file.size ? sent / file.size : 1 });
    progress(0);
    const id = await uploadFile(file, progress, pauseControl, signal);
    arrived.current.set(file, id);
    return id;
  };
  const send = async (before: RevisionDraft, draft: RevisionDraft): Promise<void> => {
    const { signal } = (stopper.current = new AbortController());
    if (!isChanged(before, draft) && job.status === 'succeeded') return;
    setBusy(true);
    pause(false);
    onProblem(null);
    try {
      const sent: Sent = {};
      for (const part of fileParts) {
        const file = fileOf(draft, part);
        if (file) sent[part] = await upload(part, file, signal);
      }
      setStep(null);
      const changes = changesOf(before, draft, sent);
      const revised = await reviseJob(job.id, { ...changes, ...notesFor(job, draft) }, key.current);
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
    send: (before: RevisionDraft, draft: RevisionDraft) => void send(before, draft),
  };
}

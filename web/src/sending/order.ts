/** Sending an order: the files first, then the job. */

import { createJob, type Job, Problem } from '../api';
import type { Kind, Order, PlaceInPart } from '../kind/kind';
import { keepSent } from './pending';
import { uploadFile, type PauseControl } from '../api/upload';

/** How often, and after how many milliseconds, it is asked again. */
const [MAX_RETRIES, BREATH_MS] = [5, 1500];

export type Sending =
  /** How much has arrived of what is this to the order; of several files, of all of them. */
  { step: 'uploading'; part: string; place?: PlaceInPart | undefined; fraction: number } | { step: 'ordering' };

export async function send(
  order: Order,
  kind: Kind,
  onStep: (step: Sending) => void,
  pauseControl: PauseControl,
  signal: AbortSignal,
): Promise<Job> {
  const upload = async (file: File, part: string, place?: PlaceInPart): Promise<string> => {
    const name = place ? `${part} ${place.number}` : part;
    const known = order.sent[name];
    if (known) return known;
    const { number, count } = place ?? { number: 1, count: 1 };
    const progress = (bytes: number): void =>
      onStep({ step: 'uploading', part, place, fraction: (number - 1 + (file.size ? bytes / file.size : 1)) / count });
    onStep({ step: 'uploading', part, place, fraction: (number - 1) / count });
    const id = await uploadFile(file, progress, pauseControl, signal);
    order.sent[name] = id;
    await keepSent(order);
    return id;
  };
  const request = await kind.request(order, upload);
  onStep({ step: 'ordering' });
  return patiently(() => createJob({ kind: order.kind, ...request }, order.key), signal);
}

/** The sending of many files may have used up what may be asked within a minute: a moment later it may be asked again. */
async function patiently<T>(ask: () => Promise<T>, signal: AbortSignal): Promise<T> {
  for (let turn = 1; ; turn++) {
    try {
      return await ask();
    } catch (error) {
      if (!(error instanceof Problem) || error.code !== 'rate_limited' || turn === MAX_RETRIES || signal.aborted) throw error;
      await new Promise((wake) => setTimeout(wake, BREATH_MS));
    }
  }
}

/** Sending an order: the files first, then the job. */

import { createJob, type Job } from '../api';
import type { Kind, Order } from '../kind/kind';
import { keepPending } from './pending';
import { uploadFile, type PauseControl } from '../api/upload';

export type Sending =
  /** How much has arrived of the file that is this to the order. */
  { step: 'uploading'; part: string; fraction: number } | { step: 'ordering' };

export async function send(
  order: Order,
  kind: Kind,
  onStep: (step: Sending) => void,
  pauseControl: PauseControl,
  signal: AbortSignal,
): Promise<Job> {
  const upload = async (file: File, part: string): Promise<string> => {
    const known = order.sent[part];
    if (known) return known;
    onStep({ step: 'uploading', part, fraction: 0 });
    const progress = (bytes: number): void =>
      onStep({ step: 'uploading', part, fraction: file.size ? bytes / file.size : 1 });
    const id = await uploadFile(file, progress, pauseControl, signal);
    order.sent[part] = id;
    await keepPending(order);
    return id;
  };
  const request = await kind.request(order, upload);
  onStep({ step: 'ordering' });
  return createJob({ kind: order.kind, ...request }, order.key);
}

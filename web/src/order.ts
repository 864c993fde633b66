/** Sending an order: the files first, then the job. */

import { createPortrait, type Job, type PortraitOptions } from './api';
import type { Performance } from './components/performances';
import { stem } from './format';
import { plain } from './strings';
import { uploadFile } from './upload';

export type Sending = { step: 'portrait' | 'video'; fraction: number } | { step: 'ordering' };

/** One attempt of a user. Sent again after a broken line, it neither uploads nor orders anything twice. */
export interface Order {
  portrait: File;
  performance: Performance;
  options: PortraitOptions;
  key: string;
  sent: Map<File, string>;
}

export function newOrder(portrait: File, performance: Performance, options: PortraitOptions): Order {
  return { portrait, performance, options, key: randomKey(), sent: new Map() };
}

export async function send(order: Order, onStep: (step: Sending) => void, signal: AbortSignal): Promise<Job> {
  const upload = async (file: File, step: 'portrait' | 'video'): Promise<string> => {
    const known = order.sent.get(file);
    if (known) return known;
    onStep({ step, fraction: 0 });
    const id = await uploadFile(file, (sent) => onStep({ step, fraction: file.size ? sent / file.size : 1 }), signal);
    order.sent.set(file, id);
    return id;
  };

  const { portrait, performance } = order;
  const image = await upload(portrait, 'portrait');
  const driver = performance.by === 'name' ? performance.name : await upload(performance.file, 'video');
  onStep({ step: 'ordering' });
  const names = {
    portrait: plain(stem(portrait.name)),
    performance: plain(performance.by === 'name' ? performance.name : stem(performance.file.name)),
  };
  return createPortrait({ image, driver }, order.options, names, order.key);
}

/** `crypto.randomUUID` exists on secure pages only; a service on a LAN is not one. */
function randomKey(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, '0')).join('');
}

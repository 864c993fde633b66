/** Sending an order: the files first, then the job. */

import { type CharacterOptions, createJob, type Job, type MotionName, type PortraitOptions } from './api';
import type { Performance } from './kinds/portrait/performances';
import { stem } from './format';
import { randomKey } from './key';
import { AUTO, motionName } from './names';
import { keepPending } from './pending';
import { plain, strings } from './strings';
import { uploadFile, type Valve } from './upload';

/** The files that an order, or a correction, may hold. */
export type FilePart = 'portrait' | 'video' | 'photo' | 'motion' | 'mask' | 'labels';
export type Sending = { step: FilePart; fraction: number } | { step: 'ordering' };

/** How a character moves: one of our clips, or a file. */
export type Motion =
  | { by: 'name'; name: MotionName }
  /** One of the user's own, which the service keeps. */
  | { by: 'kept'; name: string }
  | { by: 'file'; file: File };

/** What is wanted. Sent again after a broken line, or by a later page, it neither uploads nor orders anything twice. */
interface Wanted {
  key: string;
  /** The ids of what has arrived. */
  sent: { [Part in FilePart]?: string };
}
export interface PortraitOrder extends Wanted {
  kind: 'portrait';
  portrait: File;
  performance: Performance;
  options: PortraitOptions;
}
export interface CharacterOrder extends Wanted {
  kind: 'character';
  photo: File;
  motion: Motion;
  options: CharacterOptions;
}
export type Order = PortraitOrder | CharacterOrder;

export const portraitOrder = (portrait: File, performance: Performance, options: PortraitOptions): Order => ({
  ...{ kind: 'portrait', portrait, performance, options },
  ...{ key: randomKey(), sent: {} },
});

export const characterOrder = (photo: File, motion: Motion, options: CharacterOptions): Order => ({
  ...{ kind: 'character', photo, motion, options },
  ...{ key: randomKey(), sent: {} },
});

const nameOf = (driver: string): string => (driver === AUTO ? strings.studio.auto : plain(driver));
const fileName = (file: File): string => plain(stem(file.name));

function performanceOf(performance: Performance): string {
  switch (performance.by) {
    case 'name':
      return nameOf(performance.name);
    case 'file':
      return fileName(performance.file);
    case 'reactive':
      return strings.studio.reactive;
  }
}

function motionOf(motion: Motion): string {
  switch (motion.by) {
    case 'name':
      return motionName(motion.name);
    case 'kept':
      return plain(motion.name);
    case 'file':
      return fileName(motion.file);
  }
}

/** What an order is called: its picture, and what the picture is to do. */
export const namesOf = (order: Order): { picture: string; performance: string } =>
  order.kind === 'character'
    ? { picture: fileName(order.photo), performance: motionOf(order.motion) }
    : { picture: fileName(order.portrait), performance: performanceOf(order.performance) };

export async function send(
  order: Order,
  onStep: (step: Sending) => void,
  valve: Valve,
  signal: AbortSignal,
): Promise<Job> {
  const upload = async (file: File, step: FilePart): Promise<string> => {
    const known = order.sent[step];
    if (known) return known;
    onStep({ step, fraction: 0 });
    const progress = (bytes: number): void => onStep({ step, fraction: file.size ? bytes / file.size : 1 });
    const id = await uploadFile(file, progress, valve, signal);
    order.sent[step] = id;
    await keepPending(order);
    return id;
  };
  return order.kind === 'character' ? sendCharacter(order, upload, onStep) : sendPortrait(order, upload, onStep);
}

type Upload = (file: File, step: FilePart) => Promise<string>;
type OnStep = (step: Sending) => void;

async function sendPortrait(order: PortraitOrder, upload: Upload, onStep: OnStep): Promise<Job> {
  const { performance, options } = order;
  const image = await upload(order.portrait, 'portrait');
  const names = namesOf(order);
  const metadata = { portrait: names.picture, performance: names.performance };
  if (performance.by === 'reactive') {
    onStep({ step: 'ordering' });
    return createJob({ kind: 'portrait', inputs: { image }, options: { ...options, reactive: true }, metadata }, order.key);
  }
  const driver = performance.by === 'name' ? performance.name : await upload(performance.file, 'video');
  onStep({ step: 'ordering' });
  return createJob({ kind: 'portrait', inputs: { image, driver }, options, metadata }, order.key);
}

async function sendCharacter(order: CharacterOrder, upload: Upload, onStep: OnStep): Promise<Job> {
  const { motion, options } = order;
  const photo = await upload(order.photo, 'photo');
  const moved = motion.by === 'file' ? await upload(motion.file, 'motion') : motion.name;
  const names = namesOf(order);
  const metadata = { photo: names.picture, ...(motion.by !== 'name' && { motion: names.performance }) };
  onStep({ step: 'ordering' });
  return createJob({ kind: 'character', inputs: { photo, motion: moved }, options, metadata }, order.key);
}

/** An order of a portrait: the picture, and what it is to act out. */

import type { JobRequest } from '../../api';
import type { PortraitOptions } from './types';
import { randomKey } from '../../api/idempotency';
import { fileTitle } from '../../language/format';
import { words as portraitWords } from './words';
import type { Order, OrderNames, Upload } from '../../kind/kind';
import { AUTO } from '../../performances/drivers';
import { type Performance as Played, performanceTitle } from '../../performances/performance';

/** By `reactive` there is no one performance: the portrait is to show many, on demand. */
export type Performance = Played | { by: 'reactive' };

export interface PortraitOrder extends Order {
  kind: 'portrait';
  portrait: File;
  performance: Performance;
  options: PortraitOptions;
}

export const portraitOrder = (portrait: File, performance: Performance, options: PortraitOptions): PortraitOrder => ({
  ...{ kind: 'portrait', portrait, performance, options },
  ...{ key: randomKey(), sent: {} },
});

function performanceOf(performance: Performance): string {
  if (performance.by === 'reactive') return portraitWords.studio.reactive;
  return performance.by === 'name' && performance.name === AUTO ? portraitWords.studio.auto : performanceTitle(performance);
}

export const namesOf = (order: PortraitOrder): OrderNames => ({
  picture: fileTitle(order.portrait),
  performance: performanceOf(order.performance),
});

export async function request(order: PortraitOrder, upload: Upload): Promise<JobRequest> {
  const { performance, options } = order;
  const image = await upload(order.portrait, 'portrait');
  const names = namesOf(order);
  const metadata = { portrait: names.picture, performance: names.performance };
  if (performance.by === 'reactive') return { inputs: { image }, options: { ...options, reactive: true }, metadata };
  const driver = performance.by === 'name' ? performance.name : await upload(performance.file, 'video');
  return { inputs: { image, driver }, options, metadata };
}

/** An order of a portrait: the picture, and what it is to act out. */

import type { JobRequest } from '../../api';
import type { PortraitOptions } from './types';
import { randomKey } from '../../api/idempotency';
import { fileTitle } from '../../language/format';
import { words as portraitWords } from './words';
import { plain } from '../../language/strings';
import type { Order, OrderNames, Upload } from '../../kind/kind';
import { AUTO } from './drivers';

/** By `reactive` there is no one performance: the portrait is to show many, on demand. */
export type Performance = { by: 'name'; name: string } | { by: 'file'; file: File } | { by: 'reactive' };

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
  switch (performance.by) {
    case 'name':
      return performance.name === AUTO ? portraitWords.studio.auto : plain(performance.name);
    case 'file':
      return fileTitle(performance.file);
    case 'reactive':
      return portraitWords.studio.reactive;
  }
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

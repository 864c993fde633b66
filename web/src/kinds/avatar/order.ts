/** An order of an avatar: the clips, how it is to move, and whose face it is to follow. */

import type { JobRequest } from '../../api';
import { randomKey } from '../../api/idempotency';
import type { Order, OrderNames, Upload } from '../../kind/kind';
import { fileTitle } from '../../language/format';
import { motionTitle } from '../../motion/draft';
import type { Motion } from '../../motion/types';

export interface AvatarOrder extends Order {
  kind: 'avatar';
  body: File;
  head: File | null;
  more: readonly File[];
  motion: Motion;
  driver: File | null;
  options: object;
}

export const avatarOrder = (given: Pick<AvatarOrder, 'body' | 'head' | 'more' | 'motion' | 'driver' | 'options'>): AvatarOrder => ({
  ...given,
  ...{ kind: 'avatar', key: randomKey(), sent: {} },
});

export const namesOf = ({ body, driver, motion }: AvatarOrder): OrderNames => ({
  picture: fileTitle(body),
  performance: driver ? fileTitle(driver) : motionTitle(motion),
});

export async function request(order: AvatarOrder, upload: Upload): Promise<JobRequest> {
  const { motion, options } = order;
  const inputs: JobRequest['inputs'] = { body: await upload(order.body, 'body') };
  if (order.head) inputs.head = await upload(order.head, 'head');
  if (order.more.length) {
    const further: string[] = [];
    for (const [index, clip] of order.more.entries()) further.push(await upload(clip, index ? `more ${index + 1}` : 'more'));
    inputs.more = further;
  }
  inputs.motion = motion.by === 'file' ? await upload(motion.file, 'motion') : motion.name;
  if (order.driver) inputs.driver = await upload(order.driver, 'driver');
  const { picture, performance } = namesOf(order);
  return { inputs, options, metadata: { picture, ...((order.driver || motion.by !== 'name') && { performance }) } };
}

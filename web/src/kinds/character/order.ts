/** An order of a character: the picture, and how it is to move. */

import type { JobRequest } from '../../api';
import type { CharacterOptions } from './types';
import { randomKey } from '../../api/idempotency';
import { fileTitle } from '../../language/format';
import type { Order, OrderNames, Upload } from '../../kind/kind';
import { motionTitle } from '../../motion/draft';
import type { Motion } from '../../motion/types';

export interface CharacterOrder extends Order {
  kind: 'character';
  photo: File;
  motion: Motion;
  options: CharacterOptions;
}

export const characterOrder = (photo: File, motion: Motion, options: CharacterOptions): CharacterOrder => ({
  ...{ kind: 'character', photo, motion, options },
  ...{ key: randomKey(), sent: {} },
});

export const namesOf = (order: CharacterOrder): OrderNames => ({
  picture: fileTitle(order.photo),
  performance: motionTitle(order.motion),
});

export async function request(order: CharacterOrder, upload: Upload): Promise<JobRequest> {
  const { motion, options } = order;
  const photo = await upload(order.photo, 'photo');
  const moved = motion.by === 'file' ? await upload(motion.file, 'motion') : motion.name;
  const names = namesOf(order);
  const metadata = { photo: names.picture, ...(motion.by !== 'name' && { motion: names.performance }) };
  return { inputs: { photo, motion: moved }, options, metadata };
}

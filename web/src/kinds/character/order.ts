/** An order of a character: the picture, and how it is to move. */

import type { JobRequest } from '../../api';
import type { CharacterOptions, MotionName } from './types';
import { randomKey } from '../../api/idempotency';
import { fileTitle } from '../../language/format';
import { plain } from '../../language/strings';
import type { Order, OrderNames, Upload } from '../../kind/kind';
import { motionName } from './motion/motion_names';

/** How a character moves: one of our clips, or a file. */
export type Motion =
  | { by: 'name'; name: MotionName }
  /** One of the user's own, which the service keeps. */
  | { by: 'kept'; name: string }
  | { by: 'file'; file: File };

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

function motionOf(motion: Motion): string {
  switch (motion.by) {
    case 'name':
      return motionName(motion.name);
    case 'kept':
      return plain(motion.name);
    case 'file':
      return fileTitle(motion.file);
  }
}

export const namesOf = (order: CharacterOrder): OrderNames => ({
  picture: fileTitle(order.photo),
  performance: motionOf(order.motion),
});

export async function request(order: CharacterOrder, upload: Upload): Promise<JobRequest> {
  const { motion, options } = order;
  const photo = await upload(order.photo, 'photo');
  const moved = motion.by === 'file' ? await upload(motion.file, 'motion') : motion.name;
  const names = namesOf(order);
  const metadata = { photo: names.picture, ...(motion.by !== 'name' && { motion: names.performance }) };
  return { inputs: { photo, motion: moved }, options, metadata };
}

/** Avatars: two clips of a person become one that games take. Ordered and shown as the service describes them. */

import type { Kind } from '../../kind/kind';
import { genericKind } from '../generic';
import type { GenericOrder } from '../generic/order';
import { words } from './words';

export const avatar: Kind<GenericOrder> = {
  ...genericKind('avatar'),
  label: words.label,
  stages: words.stages,
  failures: words.failures,
  differences: words.differences,
  files: words.files,
  shared: {
    title: words.sharedTitle,
    alt: words.result,
    hasSound: false,
    downloads: [
      [/^avatar\.glb$/, words.glb],
      [/^avatar\.usdz$/, words.usdz],
      [/^turntable\.mp4$/, words.video],
    ],
    opened: /^(avatar\.(glb|usdz)|(turntable|animation)\.mp4|poster\.jpg)$/,
  },
  endings: { body: 'mp4', head: 'mp4', motion: 'bvh', driver: 'mp4' },
};

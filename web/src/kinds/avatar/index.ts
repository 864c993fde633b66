/** Avatars: two clips of a person become one that games take. */

import type { Kind } from '../../kind/kind';
import { motionName } from '../../motion/motion_names';
import { textOf } from '../../works/inputs';
import { withViewer } from '../../viewer/part';
import { genericKind } from '../generic';
import { type AvatarOrder, namesOf, request } from './order';
import { avatarOptions, USUAL_MOTION } from './types';
import { words } from './words';

const namedMotion: Kind['performance'] = (job) => motionName(avatarOptions(job).motion ?? USUAL_MOTION);

export const avatar: Kind<AvatarOrder> = {
  ...genericKind('avatar'),
  label: words.label,
  link: '#/avatar',
  loadStudio: () => import('./studio'),
  loadProgress: () => import('./measured'),
  loadResult: () => withViewer(import('./result')),
  loadCorrections: () => import('./corrections/panel'),
  loadShared: () => import('./shared'),
  stages: words.stages,
  failures: words.failures,
  differences: words.differences,
  valueOf: (job, name) => (name === 'motion' && !job.inputs.motion ? namedMotion(job) : null),
  pictureInput: 'body', // of an avatar that was there already there is none: its id is a job's
  performance: (job) => textOf(job.metadata.performance) ?? (job.inputs.motion || job.inputs.driver ? null : namedMotion(job)),
  performed: words.show.does,
  namesOf,
  request,
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
  inspections: ['motion'],
  files: words.files,
  endings: { body: 'mp4', head: 'mp4', motion: 'bvh', driver: 'mp4', avatar: 'glb' },
};

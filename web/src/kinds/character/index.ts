/** Characters: somebody steps out of their picture, and can be taken along in 3D. */

import { characterOptions } from './types';
import { textOf } from '../../works/inputs';
import { strings } from '../../language/strings';
import type { Kind } from '../../kind/kind';
import { DEFAULT_MOTION, motionName } from '../../motion/motion_names';
import { type CharacterOrder, namesOf, request } from './order';
import { withViewer } from '../../viewer/part';
import { words } from './words';

const namedMotion: Kind['performance'] = (job) => motionName(characterOptions(job).motion ?? DEFAULT_MOTION);

export const character: Kind<CharacterOrder> = {
  name: 'character',
  label: words.label,
  link: '#/character',
  loadStudio: () => import('./studio'),
  loadProgress: null,
  loadResult: () => withViewer(import('./result')),
  loadCorrections: () => import('./corrections/panel'),
  loadShared: () => import('./shared'),
  stages: words.stages,
  failures: words.failures,
  differences: words.differences,
  valueOf: (job, name) => (name === 'motion' && !job.inputs.motion ? namedMotion(job) : null),
  pictureInput: 'photo',
  pictureName: ({ metadata }) => textOf(metadata.photo),
  performance: (job) => (textOf(job.inputs.motion) ? textOf(job.metadata.motion) : namedMotion(job)),
  performed: words.character.does,
  namesOf,
  request,
  shared: {
    title: words.sharedTitle,
    alt: words.character.result,
    hasSound: false,
    downloads: [
      [/^character\.glb$/, words.character.glb],
      [/^character\.usdz$/, words.character.usdz],
      [/^animation\./, strings.job.download],
    ],
    // what hangs their picture on a wall, too, empty once they have stepped out of it
    opened: /^(animation\..+|poster\.jpg|character(-\d+)?\.(glb|usdz)|skeleton\.json|background\.png)$/,
  },
  inspections: ['motion'],
  files: words.files,
  endings: { photo: 'jpg', motion: 'bvh' },
};

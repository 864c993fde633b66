/** Personas: a collection of photos of somebody becomes a puppet that plays anybody's performance. */

import type { Kind } from '../../kind/kind';
import { plain } from '../../language/strings';
import { isFileId, isUrl, textOf } from '../../works/inputs';
import { genericKind } from '../generic';
import { namesOf, type PersonaOrder, request } from './order';
import { words } from './words';

const performance: Kind['performance'] = ({ inputs, metadata }) => {
  const driver = textOf(inputs.driver);
  return textOf(metadata.performance) ?? (driver && !isFileId(driver) && !isUrl(driver) ? plain(driver) : null);
};

export const persona: Kind<PersonaOrder> = {
  ...genericKind('persona'),
  label: words.label,
  link: '#/persona',
  loadStudio: () => import('./studio'),
  loadProgress: () => import('./progress'),
  loadResult: () => import('./result'),
  loadCorrections: () => import('./corrections/panel'),
  loadShared: () => import('./shared'),
  stages: words.stages,
  failures: words.failures,
  differences: words.differences,
  valueOf: (job, name) => (name === 'driver' ? performance(job) : null),
  pictureInput: 'photos',
  performance,
  performed: words.show.plays,
  namesOf,
  request,
  shared: {
    title: words.sharedTitle,
    alt: words.result,
    hasSound: false,
    downloads: [
      [/^animation\.mp4$/, words.show.video],
      [/^still\.png$/, words.show.picture],
      [/^puppet\.glb$/, words.show.glb],
    ],
    // never the photos' faces, nor what it can be driven with
    opened: /^(animation\.mp4|still\.png|puppet\.glb|puppet_textures\.(jpg|json)|poster\.jpg)$/,
  },
  files: words.files,
  endings: { photos: 'zip', persona: 'npz', driver: 'mp4', driver_photos: 'zip', background_picture: 'png' },
};

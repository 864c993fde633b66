/** Portraits: a picture of a face acts out a performance. */

import { portraitOptions } from './types';
import { isFileId, isUrl, textOf } from '../../works/inputs';
import { plain, strings } from '../../language/strings';
import type { Kind } from '../../kind/kind';
import { namesOf, type PortraitOrder, request } from './order';
import { words } from './words';

const performance: Kind['performance'] = ({ inputs, metadata }) => {
  const driver = textOf(inputs.driver);
  return textOf(metadata.performance) ?? (driver && !isFileId(driver) && !isUrl(driver) ? plain(driver) : null);
};

export const portrait: Kind<PortraitOrder> = {
  name: 'portrait',
  label: words.label,
  link: '#/',
  loadStudio: () => import('./studio'),
  loadProgress: null,
  loadResult: () => import('./result'),
  loadCorrections: () => import('./corrections/panel'),
  loadShared: null,
  stages: words.stages,
  failures: words.failures,
  differences: words.differences,
  valueOf(job, name) {
    if (name === 'strength') return `${Math.round((portraitOptions(job).strength ?? 1) * 100)}%`;
    return name === 'driver' ? performance(job) : null;
  },
  pictureInput: 'image',
  pictureName: ({ metadata }) => textOf(metadata.portrait),
  performance,
  performed: words.result.performance,
  namesOf,
  request,
  shared: {
    title: words.sharedTitle,
    alt: words.result.alt,
    hasSound: false,
    downloads: [[/^animation\./, strings.job.download]],
    opened: /^(animation\..+|poster\.jpg)$/,
  },
  inspections: ['moments'],
  files: words.files,
  endings: { image: 'jpg', driver: 'mp4' },
};

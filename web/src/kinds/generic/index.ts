/** A kind without a folder of its own: what the page shows of it comes from the service's description of it, GET /v1/kinds. */

import { isFileId, isUrl, textOf } from '../../works/inputs';
import { plain, strings } from '../../language/strings';
import type { Kind } from '../../kind/kind';
import { type GenericOrder, namesOf, request } from './order';

const loadStudio = () => import('./studio');
const loadResult = () => import('./result');
const loadShared = () => import('./shared');
const MEDIA = /\.(jpe?g|png|webp|gif|mp4|webm|mp3|wav|ogg|glb)$/;

/** A folder of its own may take this and say what it has otherwise. */
export const genericKind = (name: string): Kind<GenericOrder> => ({
  name,
  label: plain(name),
  link: `#/make/${encodeURIComponent(name)}`,
  loadStudio,
  loadProgress: null,
  loadResult,
  loadCorrections: null,
  loadShared,
  stages: {},
  failures: {},
  differences: {},
  valueOf: () => null,
  pictureInput: null,
  pictureName: ({ metadata }) => textOf(metadata.picture),
  performance: ({ metadata, inputs }) => {
    const named = Object.values(inputs).find((input) => textOf(input) && !isFileId(input) && !isUrl(String(input)));
    return textOf(metadata.performance) ?? (named === undefined ? null : plain(String(named)));
  },
  performed: (performance) => performance,
  namesOf,
  request,
  shared: {
    title: strings.generic.sharedTitle(plain(name)),
    alt: strings.generic.result(plain(name)),
    hasSound: true,
    downloads: [],
    opened: MEDIA,
  },
  inspections: [],
  files: {},
  endings: {},
});

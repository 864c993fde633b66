/** Pictures to try characters with. */

import type { SamplePicture } from '../../studio/samples/sample_pictures';
import { words } from './words';

const alts = words.samples;

export const samples: readonly SamplePicture[] = [
  { name: 'woman-in-red', title: 'Woman in red', alt: alts['woman-in-red'], smallHeight: 117 },
  { name: 'man-in-green', title: 'Man in green', alt: alts['man-in-green'], smallHeight: 117 },
];

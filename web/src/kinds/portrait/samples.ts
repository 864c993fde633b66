/** Pictures to try portraits with. */

import type { SamplePicture } from '../../studio/samples/sample_pictures';
import { words } from './words';

const alts = words.samples;

export const samples: readonly SamplePicture[] = [
  { name: 'grace-hopper', title: 'Grace Hopper', alt: alts['grace-hopper'], smallHeight: 88 },
  { name: 'eileen-collins', title: 'Eileen Collins', alt: alts['eileen-collins'], smallHeight: 88 },
  { name: 'painted-man', title: 'Painted man', alt: alts['painted-man'], smallHeight: 88 },
  { name: 'rendered-man', title: 'Rendered man', alt: alts['rendered-man'], smallHeight: 88 },
];

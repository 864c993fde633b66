/** The words of motions, in the page's language. */

import { inLanguage } from '../language/strings';
import english, { type MotionWords } from './words/en';

export const words: MotionWords = await inLanguage(
  english,
  import.meta.glob<{ default: MotionWords }>(['./words/*.ts', '!./words/en.ts']),
);

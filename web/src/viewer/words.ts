/** The words of the viewer, in the page's language. */

import { inLanguage } from '../language/strings';
import english, { type ViewerWords } from './words/en';

export const words: ViewerWords = await inLanguage(
  english,
  import.meta.glob<{ default: ViewerWords }>(['./words/*.ts', '!./words/en.ts']),
);

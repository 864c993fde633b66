/** The words of live portraits, in the page's language. */

import { inLanguage } from '../language/strings';
import english, { type LiveWords } from './words/en';

export const words: LiveWords = await inLanguage(
  english,
  import.meta.glob<{ default: LiveWords }>(['./words/*.ts', '!./words/en.ts']),
);

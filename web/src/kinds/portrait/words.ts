/** The words of portraits, in the page's language. */

import { inLanguage } from '../../language/strings';
import english, { type PortraitWords } from './words/en';

export const words: PortraitWords = await inLanguage(
  english,
  import.meta.glob<{ default: PortraitWords }>(['./words/*.ts', '!./words/en.ts']),
);

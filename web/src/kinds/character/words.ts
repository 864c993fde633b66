/** The words of characters, in the page's language. */

import { inLanguage } from '../../language/strings';
import english, { type CharacterWords } from './words/en';

export const words: CharacterWords = await inLanguage(
  english,
  import.meta.glob<{ default: CharacterWords }>(['./words/*.ts', '!./words/en.ts']),
);

/** The words of personas, in the page's language. */

import { inLanguage } from '../../language/strings';
import english, { type PersonaWords } from './words/en';

export const words: PersonaWords = await inLanguage(
  english,
  import.meta.glob<{ default: PersonaWords }>(['./words/*.ts', '!./words/en.ts']),
);

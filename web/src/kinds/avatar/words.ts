/** The words of avatars, in the page's language. */

import { inLanguage } from '../../language/strings';
import english, { type AvatarWords } from './words/en';

export const words: AvatarWords = await inLanguage(
  english,
  import.meta.glob<{ default: AvatarWords }>(['./words/*.ts', '!./words/en.ts']),
);

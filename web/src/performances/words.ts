/** The words of performances, in the page's language. */

import { inLanguage } from '../language/strings';
import english, { type PerformanceWords } from './words/en';

export const words: PerformanceWords = await inLanguage(
  english,
  import.meta.glob<{ default: PerformanceWords }>(['./words/*.ts', '!./words/en.ts']),
);

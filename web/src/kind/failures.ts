/** What went wrong and what to do, by the service's codes: the page's own words, and those of the kinds. */

import { strings } from '../language/strings';
import type { Kind } from './kind';

/** A code means one thing, whichever kind of job meets it. */
export const failureTitle = (kinds: readonly Kind[], code: string): string =>
  strings.failures[code] ?? kinds.find(({ failures }) => code in failures)?.failures[code] ?? strings.failed;

/** The sentence that says what to do comes from the service, but where it does not answer. */
export const failureRemedy = (code: string, detail: string): string =>
  detail || (strings.remedies[code] ?? strings.remedy);

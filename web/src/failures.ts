/** What went wrong and what to do, by the service's codes: the page's own words, and those of the kinds. */

import { kinds } from './kinds';
import { strings } from './strings';

/** A code means one thing, whichever kind of job meets it. */
export const failureTitle = (code: string): string =>
  strings.failures[code] ?? kinds.find(({ failures }) => code in failures)?.failures[code] ?? strings.failed;

/** The sentence that says what to do comes from the service, but where it does not answer. */
export const failureRemedy = (code: string, detail: string): string =>
  detail || (strings.remedies[code] ?? strings.remedy);

/** What is being chosen in the studio of personas. */

import type { Performance } from '../../performances/performance';
import type { Collected } from '../../studio/given_files/collection';
import { useDraft } from '../../studio/draft';
import type { Options } from '../generic/fields';
import type { Earlier } from './order';

export interface Draft {
  from: 'photos' | 'persona';
  photos: readonly Collected[];
  /** How many of the files that were given last were no photos. */
  others: number;
  persona: Earlier | null;
  /** Photos of who performs. */
  performer: readonly Collected[];
  /** A picture for the puppet to stand before. */
  backdrop: File | null;
  /** Undefined: nobody has chosen yet. Null: none. */
  performance: Performance | null | undefined;
  agreed: boolean;
  options: Options;
}

const EMPTY: Draft = {
  ...{ from: 'photos', photos: [], others: 0, persona: null, performer: [], backdrop: null },
  ...{ performance: undefined, agreed: false, options: {} },
};

export const usePersonaDraft = () => useDraft('persona', EMPTY);

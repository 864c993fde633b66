/** What stages are called: by the kind itself, by the page, or by another kind that has one of that name. */

import { plain, strings } from '../language/strings';
import type { Kinds } from './kinds';

export const stageName = (kinds: Kinds, kind: string, stage: string): string =>
  kinds.of(kind).stages[stage] ??
  strings.stages[stage] ??
  kinds.all.find(({ stages }) => stage in stages)?.stages[stage] ??
  plain(stage);

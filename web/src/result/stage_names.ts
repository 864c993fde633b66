/** What stages are called: by the kind itself, by the page, or by another kind that has one of that name. */

import { kindOf, kinds } from '../kinds';
import { plain, strings } from '../strings';

export const stageName = (kind: string, stage: string): string =>
  kindOf(kind).stages[stage] ??
  strings.stages[stage] ??
  kinds.find(({ stages }) => stage in stages)?.stages[stage] ??
  plain(stage);

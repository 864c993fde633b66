/** Links are signed anew whenever a job is told of: what is shown already is not fetched again until it is another file. */

import { useMemo } from 'preact/hooks';
import type { Artifact } from '../api';

export const useSteadyUrl = (artifact: Artifact | undefined): string | undefined => useMemo(() => artifact?.url, [artifact?.sha256]);

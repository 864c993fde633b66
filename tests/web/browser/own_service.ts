/**
 * The service of one file of tests and of no other: what a file leaves behind ends with it. The import starts it; it has the
 * jobs of `finished_jobs` and nothing else. `somebody` is the file of a picture: whom its character is of.
 */

import { afterAll, inject } from 'vitest';
import { serve } from './service';

const { folder, jobs, somebody } = inject('finished');
const { address, end } = await serve({}, folder);
afterAll(end);

export { address, jobs as finished, somebody };

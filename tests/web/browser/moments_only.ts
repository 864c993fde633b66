/** Imported before all else by files in which videos are searched for emotions and nothing else is made: what is ordered then waits. */

import { shared } from './service';

shared.GALATEA_WORKER_KINDS = 'moments';

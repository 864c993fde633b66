/** Imported before all else by files in which portraits are made and nothing else: their worker readies that kind of job alone. */

import { shared } from './service';

shared.GALATEA_WORKER_KINDS = 'portrait';

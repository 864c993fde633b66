/**
 * Imported before all else by files whose tests look at what is finished and have nothing made: their service has no worker,
 * which readies every kind of job and costs more than they do.
 */

import { shared } from './service';

shared.GALATEA_WORKER = 'false';

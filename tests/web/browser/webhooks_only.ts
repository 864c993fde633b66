/** Imported before all else by files whose webhooks are sent, which a worker does: it readies the kind of job that is soonest ready. */

import { shared } from './service';

shared.GALATEA_WORKER_KINDS = 'motion';

/** Imported before all else by files in which characters are made and nothing else: their worker readies that kind of job alone. */

import { shared } from './service';

shared.GALATEA_WORKER_KINDS = 'character,motion'; // motions are looked into before characters move by them

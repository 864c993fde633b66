/** Importing this defines `<reactive-portrait>`. */

import { ReactivePortrait } from './element';

export { ReactivePortrait, type StateChange } from './element';
export type { Shown } from './player';
export type { Profile, StatePart, TransitionPart, Trigger } from './profile';
export type { Cause } from './triggers';

if (!customElements.get('reactive-portrait')) customElements.define('reactive-portrait', ReactivePortrait);

/** What motions are called. */

import type { MotionName } from './types';
import { words } from './words';

/** A built-in motion in the page's language. */
export const motionName = (motion: MotionName): string => words.names[motion];

/** The clip into which characters step where nothing else is said. */
export const DEFAULT_MOTION: MotionName = 'walk';

/** Two videos in step: the result leads, the performance follows. */

/** How far apart, in seconds, the two may be while they play before the follower is set right: about two frames. */
export const TOLERANCE = 0.08;

/** How far apart, in seconds, the two may be while they rest: less than a frame of any video. */
export const AT_REST = 0.004;

/**
 * Where the performance is when the result is at `time`: later by the start of the trimmed part, and at
 * its end at the latest. Unknown durations (not loaded yet) are NaN and bound nothing.
 */
export function followerTime(time: number, start: number, duration: number): number {
  const wanted = time + start;
  return Number.isFinite(duration) ? Math.min(wanted, Math.max(0, duration - 0.001)) : wanted;
}

/** Whether the follower has to be set right. */
export const apart = (actual: number, wanted: number, tolerance: number): boolean =>
  Math.abs(actual - wanted) > tolerance;

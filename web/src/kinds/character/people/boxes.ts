/** Frames within a picture. */

import type { Frame } from '../../../api';
import type { Point } from '../../../picture_editor/geometry';

type Size = readonly [width: number, height: number];

/** Width and height of a frame at least. */
const MIN_FRAME_PIXELS = 8;

const clamped = (value: number, from: number, to: number): number => Math.min(Math.max(value, from), Math.max(from, to));

/** The frame that has two places at opposite corners, within the picture. */
export function frameBetween([ax, ay]: Point, [bx, by]: Point, [width, height]: Size): Frame {
  const [left, right] = [clamped(Math.min(ax, bx), 0, width - MIN_FRAME_PIXELS), clamped(Math.max(ax, bx), 0, width)];
  const [top, bottom] = [clamped(Math.min(ay, by), 0, height - MIN_FRAME_PIXELS), clamped(Math.max(ay, by), 0, height)];
  return [left, top, Math.max(MIN_FRAME_PIXELS, right - left), Math.max(MIN_FRAME_PIXELS, bottom - top)];
}

export const movedFrame = ([x, y, w, h]: Frame, dx: number, dy: number, [width, height]: Size): Frame => [
  clamped(x + dx, 0, width - w),
  clamped(y + dy, 0, height - h),
  w,
  h,
];

/** Larger by so much on either side; smaller where that is negative. */
export function enlarged([x, y, w, h]: Frame, dx: number, dy: number, size: Size): Frame {
  const [mx, my] = [x + w / 2, y + h / 2];
  const [halfWidth, halfHeight] = [Math.max(MIN_FRAME_PIXELS / 2, w / 2 + dx), Math.max(MIN_FRAME_PIXELS / 2, h / 2 + dy)];
  return frameBetween([mx - halfWidth, my - halfHeight], [mx + halfWidth, my + halfHeight], size);
}

export const rounded = (frame: Frame): Frame => frame.map((value) => Math.round(value)) as Frame;

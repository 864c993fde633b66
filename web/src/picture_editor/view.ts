/** Which part of the picture is seen. */

import type { Box, Point } from './geometry';

export type View = Box;

/** Pixels of the picture across the view at the least. */
const CLOSEST = 24;

export const whole = (width: number, height: number): View => ({ x: -0.5, y: -0.5, width, height });

/** The view nearer (`factor` > 1) or further around a place, never beyond the picture's own size. */
export function zoomed(view: View, factor: number, [x, y]: Point, picture: View): View {
  const wanted = Math.min(picture.width, Math.max(CLOSEST, view.width / factor));
  const by = view.width / wanted;
  const near = { x: x - (x - view.x) / by, y: y - (y - view.y) / by, width: view.width / by, height: view.height / by };
  return kept(near, picture);
}

/** A box with room around it, `room` its share on each side, in the shape of `picture`. */
export function around(box: Box, room: number, picture: View): View {
  const aspect = picture.width / picture.height;
  const width = Math.max(box.width * (1 + 2 * room), box.height * (1 + 2 * room) * aspect, CLOSEST);
  const size = Math.min(width, picture.width);
  const height = size / aspect;
  const [x, y] = [box.x + (box.width - size) / 2, box.y + (box.height - height) / 2];
  return kept({ x, y, width: size, height }, picture);
}

export const panned = (view: View, dx: number, dy: number): View => ({ ...view, x: view.x + dx, y: view.y + dy });

/** The view moved so that it shows nothing but the picture where it can. */
export function kept(view: View, picture: View): View {
  const within = (at: number, length: number, from: number, all: number): number =>
    length >= all ? from - (length - all) / 2 : Math.min(Math.max(at, from), from + all - length);
  return {
    ...view,
    x: within(view.x, view.width, picture.x, picture.width),
    y: within(view.y, view.height, picture.y, picture.height),
  };
}

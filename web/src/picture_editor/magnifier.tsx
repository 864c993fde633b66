/** Shows a place of the picture from near while it is covered by a hand; it stands where the hand is not. */

import type { ComponentChildren } from 'preact';
import type { Point } from './geometry';

/** How much nearer the lens shows what the stage shows, and its width on the screen. */
const MAGNIFICATION = 2.5;
const PIXELS = 120;

interface Props {
  at: Point;
  /** Pixels of the screen for one of the picture on the stage. */
  scale: number;
  /** The half of the stage on which the hand is. */
  hand: 'left' | 'right';
  children: ComponentChildren;
}

export function Magnifier({ at: [x, y], scale, hand, children }: Props) {
  const width = PIXELS / scale / MAGNIFICATION;
  return (
    <svg
      class={`magnifier ${hand === 'left' ? 'right' : 'left'}`}
      viewBox={`${x - width / 2} ${y - width / 2} ${width} ${width}`}
      aria-hidden="true"
    >
      {children}
    </svg>
  );
}

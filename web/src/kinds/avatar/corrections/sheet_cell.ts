/** One frame out of a sheet, as the background of an element of any size. */

import type { FrameSheet } from '../types';

export function cellStyle({ columns, cell, frames }: FrameSheet, url: string, place: number) {
  const rows = Math.ceil(frames.length / columns);
  const share = (index: number, count: number): string => `${count > 1 ? (100 * index) / (count - 1) : 0}%`;
  return {
    aspectRatio: `${cell[0]} / ${cell[1]}`,
    backgroundImage: `url("${url}")`,
    backgroundSize: `${100 * columns}% ${100 * rows}%`,
    backgroundPosition: `${share(place % columns, columns)} ${share(Math.floor(place / columns), rows)}`,
  };
}

/** One of the pictures of a sheet of equal ones, as the background of an element of any size. */

export interface PictureSheet {
  columns: number;
  /** How many pictures it has. */
  count: number;
  /** Width and height of each, in pixels. */
  cell: readonly [width: number, height: number];
}

export function cellStyle({ columns, count, cell }: PictureSheet, url: string, place: number) {
  const rows = Math.ceil(count / columns);
  const share = (index: number, all: number): string => `${all > 1 ? (100 * index) / (all - 1) : 0}%`;
  return {
    aspectRatio: `${cell[0]} / ${cell[1]}`,
    backgroundImage: `url("${url}")`,
    backgroundSize: `${100 * columns}% ${100 * rows}%`,
    backgroundPosition: `${share(place % columns, columns)} ${share(Math.floor(place / columns), rows)}`,
  };
}

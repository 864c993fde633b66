/** A face to begin with where none was found. */

import type { Point } from '../../../picture_editor/geometry';

/** The engine's canonical face as seen from the front: the origin between the eyes, the distance of the eyes 1. */
export const canonical: readonly Point[] = [
  [-1.166, 0.044], [-1.154, 0.286], [-1.139, 0.541], [-1.067, 0.948], [-0.978, 1.196], [-0.8, 1.466],
  [-0.643, 1.601], [-0.369, 1.762], [0, 1.831], [0.369, 1.762], [0.643, 1.601], [0.8, 1.466], [0.978, 1.196],
  [1.103, 0.81], [1.139, 0.541], [1.154, 0.286], [1.166, 0.044], [-0.927, -0.237], [-0.821, -0.325],
  [-0.663, -0.371], [-0.461, -0.36], [-0.234, -0.329], [0.234, -0.329], [0.461, -0.36], [0.663, -0.371],
  [0.821, -0.325], [0.927, -0.237], [0, 0.002], [0, 0.243], [0, 0.418], [0, 0.562], [-0.212, 0.707],
  [-0.126, 0.764], [0, 0.77], [0.126, 0.764], [0.212, 0.707], [-0.719, -0.015], [-0.618, -0.076],
  [-0.45, -0.09], [-0.281, 0.015], [-0.423, 0.034], [-0.585, 0.037], [0.281, 0.015], [0.45, -0.09],
  [0.618, -0.076], [0.719, -0.015], [0.585, 0.037], [0.423, 0.034], [-0.408, 1.129], [-0.237, 1.039],
  [-0.121, 1.013], [0, 1.035], [0.121, 1.013], [0.237, 1.039], [0.408, 1.129], [0.31, 1.205], [0.12, 1.28],
  [0, 1.289], [-0.12, 1.28], [-0.31, 1.205], [-0.369, 1.128], [-0.1, 1.123], [0, 1.128], [0.1, 1.123],
  [0.369, 1.128], [0.099, 1.131], [0, 1.136], [-0.099, 1.131],
];

/** The canonical face in the middle of a picture of this size in pixels, its chin a quarter above the lower edge. */
export function facePlaced(width: number, height: number): Point[] {
  const scale = Math.min(width / 4.2, height / 4.4);
  return canonical.map(([x, y]) => [width / 2 + x * scale, height / 2 + (y - 0.6) * scale]);
}

/** The canonical face in the box of a face that was found: as wide as it, its chin on the lower edge. */
export function faceInBox([x, y, width, height]: readonly [number, number, number, number]): Point[] {
  const xs = canonical.map(([px]) => px);
  const scale = width / (Math.max(...xs) - Math.min(...xs));
  const chin = Math.max(...canonical.map(([, py]) => py));
  return canonical.map(([px, py]) => [x + width / 2 + px * scale, y + height + (py - chin) * scale]);
}

/** Textures that are drawn with a pen, not fetched. */

import { CanvasTexture } from 'three';

/** A square of `side` pixels; nothing where the browser lends no pen. */
export function drawnTexture(side: number, draw: (pen: CanvasRenderingContext2D, side: number) => void): CanvasTexture {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = side;
  const pen = canvas.getContext('2d');
  if (pen) draw(pen, side);
  return new CanvasTexture(canvas);
}

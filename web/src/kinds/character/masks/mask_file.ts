/** Files in place of a mask or of a map of the parts: whether they fit, and what the service will read in them. */

import type { BodyPart } from '../types';
import { partColours } from './strokes';

export type Painted = 'mask' | 'labels';
export type Size = readonly [width: number, height: number];
/** Why a file cannot be taken: this browser cannot read it, or it has another size. */
export type MaskFault = { why: 'unreadable' } | { why: 'size'; size: Size };

/** Pixels of a preview's longer side, at most. */
const LARGEST = 1280;

/** Nothing where the file is as large as one of `sizes`. */
export async function faultOf(file: File, sizes: readonly Size[]): Promise<MaskFault | null> {
  const size = await sizeOf(file).catch(() => null);
  if (!size) return { why: 'unreadable' };
  return sizes.some(([width, height]) => width === size[0] && height === size[1]) ? null : { why: 'size', size };
}

/** Of a picture as it is seen: turned as the camera was held. */
export async function sizeOf(picture: Blob): Promise<Size> {
  const bitmap = await createImageBitmap(picture);
  const size = [bitmap.width, bitmap.height] as const;
  bitmap.close();
  return size;
}

/** A picture of what is read in a file: white where the person is, or the colours of the parts. */
export async function previewOf(file: Blob, what: Painted): Promise<Blob> {
  const bitmap = await createImageBitmap(file);
  const scale = Math.min(1, LARGEST / Math.max(bitmap.width, bitmap.height));
  const canvas = new OffscreenCanvas(Math.round(bitmap.width * scale), Math.round(bitmap.height * scale));
  const pen = canvas.getContext('2d') as OffscreenCanvasRenderingContext2D;
  pen.imageSmoothingEnabled = what === 'mask'; // between two parts there is no third
  pen.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  bitmap.close();
  const image = pen.getImageData(0, 0, canvas.width, canvas.height);
  (what === 'mask' ? readMask : readParts)(image.data);
  pen.putImageData(image, 0, 0);
  return canvas.convertToBlob();
}

/** Red, green, blue, alpha for each pixel, in place: how bright each is, or, of somebody cut out, how opaque. */
export function readMask(pixels: Uint8ClampedArray): void {
  const each = (at: (pixel: number) => number): void => {
    for (let i = 0; i < pixels.length; i += 4) {
      pixels.fill(at(i), i, i + 3);
      pixels[i + 3] = 255;
    }
  };
  let cutOut = false;
  for (let i = 3; i < pixels.length && !cutOut; i += 4) cutOut = pixels[i]! < 255;
  each(cutOut ? (i) => pixels[i + 3]! : (i) => (pixels[i]! + pixels[i + 1]! + pixels[i + 2]!) / 3);
}

const colours = Object.values<string>(partColours satisfies Record<BodyPart, string>).map(
  (colour) => (colour.match(/\d+/g) ?? []).map(Number) as [number, number, number],
);

/** Red, green, blue, alpha for each pixel, in place: the nearest of the parts' colours; nothing where black is nearer. */
export function readParts(pixels: Uint8ClampedArray): void {
  for (let i = 0; i < pixels.length; i += 4) {
    const [r, g, b] = [pixels[i]!, pixels[i + 1]!, pixels[i + 2]!];
    let nearest: readonly [number, number, number] | null = null;
    let shortest = r * r + g * g + b * b;
    for (const colour of colours) {
      const off = (r - colour[0]) ** 2 + (g - colour[1]) ** 2 + (b - colour[2]) ** 2;
      if (off < shortest) [nearest, shortest] = [colour, off];
    }
    pixels.set(nearest ? [...nearest, 255] : [0, 0, 0, 0], i);
  }
}

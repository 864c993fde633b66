/** A small picture of a file: many are drawn one after the other, so that the page goes on answering. */

import { useEffect, useRef, useState } from 'preact/hooks';

/** Pixels. */
const SIDE = 96;

/** The end of the row of those that are waiting to be drawn. */
let waiting: Promise<void> = Promise.resolve();

interface Props {
  file: File;
  /** Of a picture that this browser does not show, or of what is none. */
  instead: string;
}

export function Thumbnail({ file, instead }: Props) {
  const place = useRef<HTMLCanvasElement>(null);
  const [shown, setShown] = useState(true);
  useEffect(() => {
    let wanted = true;
    waiting = waiting.then(async () => {
      if (!wanted || !place.current) return;
      try {
        await draw(file, place.current);
      } catch {
        if (wanted) setShown(false);
      }
    });
    return () => {
      wanted = false;
    };
  }, [file]);
  return shown ? <canvas ref={place} width={SIDE} height={SIDE} aria-hidden="true" /> : <span class="unseen" aria-hidden="true">{instead}</span>;
}

/** The middle of a picture, as large as fills the place. Rejects where the browser does not read it. */
async function draw(file: File, place: HTMLCanvasElement): Promise<void> {
  const bitmap = await createImageBitmap(file, { resizeHeight: 2 * SIDE, resizeQuality: 'medium' });
  const side = Math.min(bitmap.width, bitmap.height);
  place
    .getContext('2d')
    ?.drawImage(bitmap, (bitmap.width - side) / 2, (bitmap.height - side) / 3, side, side, 0, 0, SIDE, SIDE);
  bitmap.close();
}

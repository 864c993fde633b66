/** The camera's frames, sent as they come: small JPEGs with their numbers, and none while the last one is on its way. */

import { type LiveLine, NUMBER_BYTES } from './picture';

/** Pixels of a frame's longest side: the face is looked at in no more. */
const LONGEST_SIDE = 640;
const QUALITY = 0.8;
/** Frames a second at most. */
const FASTEST = 30;

/** Send what a video shows until the returned function is called; nothing while the page is out of sight. */
export function feed(video: HTMLVideoElement, line: LiveLine): () => void {
  const canvas = document.createElement('canvas');
  const drawing = canvas.getContext('2d');
  let number = 0;
  let encoding = false;
  const send = (): void => {
    if (encoding || !line.free || !video.videoWidth || document.hidden) return;
    const scale = Math.min(1, LONGEST_SIDE / Math.max(video.videoWidth, video.videoHeight));
    [canvas.width, canvas.height] = [Math.round(video.videoWidth * scale), Math.round(video.videoHeight * scale)];
    drawing?.drawImage(video, 0, 0, canvas.width, canvas.height);
    encoding = true;
    canvas.toBlob(
      (picture) => {
        encoding = false;
        if (!picture) return;
        const head = new DataView(new ArrayBuffer(NUMBER_BYTES));
        head.setUint32(0, (number = (number + 1) >>> 0));
        line.send(new Blob([head.buffer, picture]));
      },
      'image/jpeg',
      QUALITY,
    );
  };
  const timer = setInterval(send, 1000 / FASTEST);
  return () => clearInterval(timer);
}

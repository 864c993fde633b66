/** One recording of a camera's stream. */

import { useEffect, useRef, useState } from 'preact/hooks';

/** What the service takes of a driving video (docs/portrait.md). */
export const LONGEST_SECONDS = 180;
export const COUNTDOWN_SECONDS = 3;

const BITS_PER_SECOND = 5_000_000;
/** Best first; MP4 can be sought in at once, WebM as browsers record it only after it was wholly read. */
const TYPES = ['video/mp4;codecs=avc1.42E01F', 'video/mp4', 'video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];

export type Recording =
  | { state: 'idle' }
  | { state: 'counting'; left: number }
  | { state: 'running'; seconds: number }
  | { state: 'done'; file: File };

export function useRecording(stream: MediaStream | null, name: string) {
  const [recording, setRecording] = useState<Recording>({ state: 'idle' });
  const recorder = useRef<MediaRecorder | null>(null);
  const timer = useRef(0);

  const reset = (): void => {
    clearInterval(timer.current);
    const running = recorder.current;
    recorder.current = null;
    if (running && running.state !== 'inactive') running.stop();
    setRecording({ state: 'idle' });
  };
  useEffect(() => reset, [stream]);

  const count = (): void => {
    let left = COUNTDOWN_SECONDS;
    setRecording({ state: 'counting', left });
    timer.current = window.setInterval(() => {
      left -= 1;
      if (left > 0) setRecording({ state: 'counting', left });
      else run();
    }, 1000);
  };
  const run = (): void => {
    clearInterval(timer.current);
    if (!stream) return;
    const type = TYPES.find((one) => MediaRecorder.isTypeSupported(one));
    const running = new MediaRecorder(stream, { ...(type && { mimeType: type }), videoBitsPerSecond: BITS_PER_SECOND });
    const parts: Blob[] = [];
    running.ondataavailable = (event) => parts.push(event.data);
    running.onstop = () => {
      if (recorder.current !== running) return; // given up
      const media = running.mimeType.replace(/;.*/, '');
      const file = new File(parts, `${name}.${media.endsWith('mp4') ? 'mp4' : 'webm'}`, { type: media });
      setRecording({ state: 'done', file });
    };
    recorder.current = running;
    running.start(1000);
    const began = performance.now();
    setRecording({ state: 'running', seconds: 0 });
    timer.current = window.setInterval(() => {
      const seconds = (performance.now() - began) / 1000;
      setRecording({ state: 'running', seconds });
      if (seconds >= LONGEST_SECONDS - 1) stop(); // a little less than what is refused
    }, 200);
  };
  const stop = (): void => {
    clearInterval(timer.current);
    recorder.current?.stop();
  };

  return { recording, begin: count, beginNow: run, stop, reset };
}

/** The visitor's camera, open while a window shows it. */

import { useEffect, useState } from 'preact/hooks';

/** Why there is no picture; the words for it are under `failures` and `remedies`. */
export type CameraTrouble = 'camera_refused' | 'camera_missing' | 'camera_busy';

/** Browsers give the camera to secure pages only: https, or this machine's own. */
export const mayUseCamera = (): boolean => Boolean(globalThis.navigator?.mediaDevices?.getUserMedia);

export interface Camera {
  stream: MediaStream | null;
  trouble: CameraTrouble | null;
  retry: () => void;
}

export function useCamera(video: MediaTrackConstraints, audio: boolean): Camera {
  const [stream, setStream] = useState<MediaStream | null>(null);
  const [trouble, setTrouble] = useState<CameraTrouble | null>(null);
  const [turn, setTurn] = useState(0);

  useEffect(() => {
    let opened: MediaStream | null = null;
    let wanted = true;
    const close = (): void => opened?.getTracks().forEach((track) => track.stop());
    navigator.mediaDevices.getUserMedia({ video, audio }).then(
      (given) => {
        opened = given;
        if (!wanted) {
          close();
          return;
        }
        setTrouble(null);
        setStream(given);
      },
      (error: unknown) => wanted && setTrouble(troubleOf(error)),
    );
    return () => {
      wanted = false;
      close();
      setStream(null);
    };
  }, [audio, turn]);

  return { stream, trouble, retry: () => setTurn((t) => t + 1) };
}

function troubleOf(error: unknown): CameraTrouble {
  const name = error instanceof DOMException ? error.name : '';
  if (name === 'NotAllowedError' || name === 'SecurityError') return 'camera_refused';
  return name === 'NotFoundError' || name === 'OverconstrainedError' ? 'camera_missing' : 'camera_busy';
}

/** What the camera sees, as in a mirror, with the place where a face belongs. */

import type { RefObject } from 'preact';
import { useEffect } from 'preact/hooks';
import { strings } from '../language/strings';

interface Props {
  stream: MediaStream | null;
  video: RefObject<HTMLVideoElement | null>;
  guide: boolean;
  onReady: () => void;
}

export function Viewfinder({ stream, video, guide, onReady }: Props) {
  useEffect(() => {
    if (video.current) video.current.srcObject = stream;
  }, [stream]);
  return (
    <>
      <video
        ref={video}
        class="mirrored"
        muted
        autoPlay
        playsInline
        aria-label={strings.camera.live}
        onPlaying={onReady}
      />
      {guide && (
        <svg class="guide" viewBox="0 0 100 100" aria-hidden="true">
          <ellipse cx="50" cy="47" rx="24" ry="33" />
        </svg>
      )}
    </>
  );
}

/** What the page is for, at a glance: a picture, and the same picture moving. It stands still for who wants it so. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { strings } from '../../language/strings';

const words = strings.demo;

interface Props {
  still: string;
  moving: string;
  /** What is seen to move. */
  alt: string;
  width: number;
  height: number;
}

export function Demo({ still, moving, alt, width, height }: Props) {
  const video = useRef<HTMLVideoElement>(null);
  const [playing, setPlaying] = useState(false);
  const play = (): void => void video.current?.play().catch(() => setPlaying(false)); // a browser may refuse
  useEffect(() => {
    if (!matchMedia('(prefers-reduced-motion: reduce)').matches) play();
  }, []);
  const label = playing ? words.pause : words.play;
  return (
    <div class="demo">
      <figure>
        <img src={still} alt="" width={width} height={height} />
        <figcaption>{words.before}</figcaption>
      </figure>
      <figure>
        <video
          ref={video}
          src={moving}
          poster={still}
          width={width}
          height={height}
          muted
          loop
          playsInline
          aria-label={alt}
          onPlay={() => setPlaying(true)}
          onPause={() => setPlaying(false)}
        />
        <button type="button" aria-label={label} title={label} onClick={() => (playing ? video.current?.pause() : play())}>
          <svg viewBox="0 0 24 24" width="20" height="20" aria-hidden="true">
            <path class="solid" d={playing ? 'M7 5h4v14H7zm6 0h4v14h-4z' : 'M8 5v14l11-7z'} />
          </svg>
        </button>
        <figcaption>{words.after}</figcaption>
      </figure>
    </div>
  );
}

/** The performances on offer, to choose one from: ours, the user's own, or a video at hand. */

import { useRef } from 'preact/hooks';
import type { Driver } from '../api';
import { isVideo, videoTypes } from '../media';
import { plain, strings } from '../strings';
import { Dropzone } from './dropzone';

export type Performance = { by: 'name'; name: string } | { by: 'file'; file: File };

interface Props {
  drivers: Driver[];
  chosen: Performance | null;
  onChoose: (performance: Performance) => void;
}

const words = strings.studio;

export function Performances({ drivers, chosen, onChoose }: Props) {
  const name = chosen?.by === 'name' ? chosen.name : null;
  const groups = [
    { title: words.performances, members: drivers.filter((d) => d.source === 'built-in') },
    { title: words.yours, members: drivers.filter((d) => d.source === 'own') },
  ].filter((group) => group.members.length > 0);

  return (
    <>
      {groups.map(({ title, members }) => (
        <fieldset class="performances" key={title}>
          <legend>{title}</legend>
          <div class="cards">
            {members.map((driver) => (
              <Card
                key={driver.name}
                driver={driver}
                checked={driver.name === name}
                onChoose={() => onChoose({ by: 'name', name: driver.name })}
              />
            ))}
          </div>
        </fieldset>
      ))}
      <h3>{words.ownVideo}</h3>
      <Dropzone
        media="video"
        file={chosen?.by === 'file' ? chosen.file : null}
        accept={videoTypes}
        accepts={isVideo}
        words={{
          drop: words.videoDrop,
          browse: words.videoBrowse,
          chosen: words.videoChosen,
          wrong: words.wrongVideo,
        }}
        onFile={(file) => onChoose({ by: 'file', file })}
      />
    </>
  );
}

interface CardProps {
  driver: Driver;
  checked: boolean;
  onChoose: () => void;
}

/** Shows the performance's first frame; plays it while it is pointed at or has the focus. */
function Card({ driver, checked, onChoose }: CardProps) {
  const video = useRef<HTMLVideoElement>(null);
  const play = (): void => {
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) return;
    void video.current?.play().catch(() => undefined); // a glance only: the name says the same
  };
  const rest = (): void => {
    if (!video.current) return;
    video.current.pause();
    video.current.currentTime = 0;
  };
  return (
    <label class={checked ? 'card checked' : 'card'} title={driver.title ?? undefined} onMouseEnter={play} onMouseLeave={rest}>
      <input
        type="radio"
        name="performance"
        value={driver.name}
        checked={checked}
        onChange={onChoose}
        onFocus={play}
        onBlur={rest}
      />
      <video ref={video} src={driver.url} muted loop playsInline preload="metadata" aria-hidden="true" tabIndex={-1} />
      <span>{plain(driver.name)}</span>
    </label>
  );
}

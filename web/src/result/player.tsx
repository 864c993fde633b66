/** The result, large, and in its corner the performance that it acts out: one play button and one slider for both. */

import { type RefObject } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { plain, strings } from '../language/strings';
import { apart, AT_REST, followerTime, TOLERANCE } from './sync';
import { Transport } from './transport';

interface Props {
  /** What the whole is called, and what the result shows. */
  label?: string;
  alt: string;
  result: string;
  poster: string | undefined;
  driver: string | null;
  /** Which one the service has chosen, where it was asked to. */
  chosen: string | null;
  /** Where in the performance the result begins, in seconds. */
  start: number;
  hasSound: boolean;
}

const words = strings.player;

export function Player(props: Props) {
  const { result, poster, driver, chosen, start, hasSound } = props;
  const leader = useRef<HTMLVideoElement>(null);
  const follower = useRef<HTMLVideoElement>(null);
  const [playing, setPlaying] = useState(false);
  const [time, setTime] = useState(0);
  const [total, setTotal] = useState(0);
  const [repeat, setRepeat] = useState(true);
  const [muted, setMuted] = useState(true);
  const [speed, setSpeed] = useState(1);
  const [unplayable, setUnplayable] = useState(false);
  const [aspect, setAspect] = useState(1);
  const [inset, setInset] = useState(true);
  const shown = inset ? driver : null;
  useInStep(leader, follower, shown, start, playing, setTime);

  useEffect(() => {
    for (const video of [leader.current, follower.current]) if (video) video.playbackRate = speed;
  }, [speed, shown]);

  const play = (): void => {
    const video = leader.current;
    if (!video) return;
    if (video.ended) video.currentTime = 0;
    void video.play().catch(() => setPlaying(false)); // a browser may refuse to begin by itself
  };
  const ended = (): void => {
    setPlaying(false);
    if (repeat) play();
  };
  const seek = (to: number): void => {
    if (!leader.current) return;
    leader.current.currentTime = to;
    setTime(to);
  };

  return (
    <section class="player" aria-label={props.label ?? words.label}>
      <div class="film" style={{ '--aspect': aspect }}>
        <figure>
          <video
            ref={leader}
            src={result}
            poster={poster}
            muted={muted}
            playsInline
            preload="auto"
            aria-label={props.alt}
            onLoadedMetadata={(event) => {
              const video = event.currentTarget;
              setTotal(video.duration);
              setAspect(aspectOf(video));
              if (!matchMedia('(prefers-reduced-motion: reduce)').matches) play();
            }}
            onPlay={() => setPlaying(true)}
            onPause={() => setPlaying(false)}
            onEnded={ended}
            onClick={() => (playing ? leader.current?.pause() : play())}
          />
          <figcaption class="visually-hidden">{strings.job.result}</figcaption>
        </figure>
        {shown && (
          <figure class="inset">
            {unplayable ? (
              <p class="unshowable">{strings.job.driverUnplayable}</p>
            ) : (
              <video
                ref={follower}
                src={shown}
                muted
                playsInline
                preload="auto"
                aria-label={strings.job.driver}
                onError={() => setUnplayable(true)}
              />
            )}
            <figcaption>{chosen ? strings.job.driverChosen(plain(chosen)) : strings.job.driver}</figcaption>
          </figure>
        )}
      </div>
      <Transport
        time={time}
        total={total}
        playing={playing}
        speed={speed}
        onPlay={() => (playing ? leader.current?.pause() : play())}
        onSeek={seek}
        onSpeed={setSpeed}
        after={
          document.fullscreenEnabled && (
            <button type="button" class="toggle" onClick={() => void leader.current?.requestFullscreen()}>
              {words.fullScreen}
            </button>
          )
        }
      >
        <button type="button" class="toggle" aria-pressed={repeat} onClick={() => setRepeat(!repeat)}>
          {words.repeat}
        </button>
        {driver && (
          <button type="button" class="toggle" aria-pressed={inset} onClick={() => setInset(!inset)}>
            {words.inset}
          </button>
        )}
        {hasSound && (
          <button type="button" class="toggle" aria-pressed={!muted} onClick={() => setMuted(!muted)}>
            {words.sound}
          </button>
        )}
      </Transport>
    </section>
  );
}

const aspectOf = (video: HTMLVideoElement): number => video.videoWidth / video.videoHeight || 1;

/** Keeps the follower with the leader, frame by frame while they play and at every seek, and tells the time. */
function useInStep(
  leader: RefObject<HTMLVideoElement | null>,
  follower: RefObject<HTMLVideoElement | null>,
  driver: string | null,
  start: number,
  playing: boolean,
  onTime: (time: number) => void,
): void {
  useEffect(() => {
    const lead = leader.current;
    const follow = follower.current;
    if (!lead) return;

    const align = (): void => {
      onTime(lead.currentTime);
      if (!follow) return;
      if (lead.paused !== follow.paused && !follow.ended) {
        if (lead.paused) follow.pause();
        else void follow.play().catch(() => undefined); // its format may not play here; the figure says so
      }
      if (follow.seeking) return; // its own `seeked` comes back here
      const wanted = followerTime(lead.currentTime, start, follow.duration);
      if (apart(follow.currentTime, wanted, lead.paused ? AT_REST : TOLERANCE)) follow.currentTime = wanted;
    };
    let frame = 0;
    const watch = (): void => {
      align();
      frame = requestAnimationFrame(watch);
    };
    if (playing) watch();
    else align();
    lead.addEventListener('seeked', align);
    follow?.addEventListener('loadedmetadata', align);
    follow?.addEventListener('seeked', align);
    return () => {
      cancelAnimationFrame(frame);
      lead.removeEventListener('seeked', align);
      follow?.removeEventListener('loadedmetadata', align);
      follow?.removeEventListener('seeked', align);
    };
  }, [playing, start, driver]);
}

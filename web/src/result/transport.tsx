/** Play and pause, where one is, and how fast: of videos and of clips. */

import type { ComponentChildren } from 'preact';
import { clock } from '../language/format';
import { strings } from '../language/strings';

const words = strings.player;
const speeds = [1, 0.5, 0.25] as const;

export function PlayButton({ playing, onPlay }: { playing: boolean; onPlay: () => void }) {
  return (
    <button type="button" class="play" onClick={onPlay}>
      <svg viewBox="0 0 24 24" width="22" height="22" aria-hidden="true">
        <path class="solid" d={playing ? 'M7 5h3.5v14H7zM13.5 5H17v14h-3.5z' : 'M8 5v14l11-7z'} />
      </svg>
      <span class="visually-hidden">{playing ? words.pause : words.play}</span>
    </button>
  );
}

interface Props {
  time: number;
  total: number;
  playing: boolean;
  speed: number;
  onPlay: () => void;
  onSeek: (time: number) => void;
  onSpeed: (speed: number) => void;
  /** Before the choice of the speed. */
  children?: ComponentChildren;
  /** Behind it. */
  after?: ComponentChildren;
}

export function Transport({ time, total, playing, speed, onPlay, onSeek, onSpeed, children, after }: Props) {
  return (
    <div class="controls">
      <PlayButton playing={playing} onPlay={onPlay} />
      <input
        type="range"
        class="scrub"
        min="0"
        max={total || 1}
        step="0.01"
        value={time}
        aria-label={words.position}
        aria-valuetext={words.time(clock(time, total), clock(total, total))}
        onInput={({ currentTarget }) => onSeek(currentTarget.valueAsNumber)}
      />
      <span class="time" aria-hidden="true">
        {clock(time, total)} / {clock(total, total)}
      </span>
      {children}
      <select aria-label={words.speed} value={speed} onChange={({ currentTarget }) => onSpeed(Number(currentTarget.value))}>
        {speeds.map((one) => (
          <option key={one} value={one}>
            {words.speeds[one]}
          </option>
        ))}
      </select>
      {after}
    </div>
  );
}

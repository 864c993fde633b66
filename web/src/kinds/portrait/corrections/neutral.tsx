/** The frame of the performance that shows what the picture shows, found by looking through the video. */

import { useEffect, useId, useRef } from 'preact/hooks';
import type { PortraitReport } from '../types';
import { count } from '../../../language/format';
import { words as portraitWords } from '../words';

const words = portraitWords.corrections;

interface Props {
  video: string | null;
  report: PortraitReport | null;
  /** Where in the video the used part begins, in seconds. */
  start: number;
  value: number | null;
  onChange: (frame: number | null) => void;
}

export function NeutralFrame({ video, report, start, value, onChange }: Props) {
  const id = useId();
  const player = useRef<HTMLVideoElement>(null);
  const shown = value ?? report?.inputs.neutral_frame ?? 0;
  const fps = report?.inputs.fps ?? 0;

  useEffect(() => {
    const element = player.current;
    if (!element || !fps) return;
    const seek = (): void => {
      element.currentTime = start + (shown + 0.5) / fps; // the middle of a frame is safely within it
    };
    if (element.readyState > 0) seek();
    element.addEventListener('loadedmetadata', seek);
    return () => element.removeEventListener('loadedmetadata', seek);
  }, [shown, fps, start, video]);

  if (!report) {
    return (
      <div class="field">
        <label for={id}>{words.neutral}</label>
        <input
          id={id}
          type="number"
          min="0"
          step="1"
          placeholder={words.automatic}
          value={value ?? ''}
          aria-describedby={`${id}-hint`}
          onInput={({ currentTarget }) => onChange(currentTarget.value === '' ? null : currentTarget.valueAsNumber)}
        />
        <small id={`${id}-hint`}>{words.neutralHint}</small>
      </div>
    );
  }
  const last = report.inputs.frames - 1;
  const go = (frame: number): void => onChange(Math.min(last, Math.max(0, frame)));
  return (
    <div class="field neutral">
      {video && <video ref={player} src={video} muted playsInline preload="auto" aria-hidden="true" tabIndex={-1} />}
      <div>
        <label for={id}>
          {words.neutral} <output>{words.frame(count(shown), count(last))}</output>
        </label>
        <input
          id={id}
          type="range"
          min="0"
          max={last}
          step="1"
          value={shown}
          aria-valuetext={words.frame(count(shown), count(last))}
          aria-describedby={`${id}-hint`}
          onInput={({ currentTarget }) => go(currentTarget.valueAsNumber)}
        />
        <small id={`${id}-hint`}>{words.neutralHint}</small>
        <div class="actions">
          <button type="button" class="toggle" disabled={shown === 0} onClick={() => go(shown - 1)}>
            {words.frameBack}
          </button>
          <button type="button" class="toggle" disabled={shown === last} onClick={() => go(shown + 1)}>
            {words.frameOn}
          </button>
          <button type="button" class="toggle" aria-pressed={value === null} onClick={() => onChange(null)}>
            {words.automatic}
          </button>
        </div>
      </div>
    </div>
  );
}

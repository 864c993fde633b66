/** The frames that were chosen of a clip: those in which the person moved, or that are blurred, are left out by a click. */

import { clock } from '../../../language/format';
import { type FrameSheet, picturesOf } from '../types';
import { cellStyle } from '../../../widgets/sheet_cell';
import { words as avatarWords } from '../words';

const words = avatarWords.correct;
/** Of a clip: what the service needs. */
const MIN_FRAMES = 12;

interface Props {
  sheet: FrameSheet;
  /** Where the sheet's picture is. */
  url: string;
  title: string;
  /** Numbers of frames. */
  leftOut: readonly number[];
  onChange: (leftOut: readonly number[]) => void;
}

export function FramesField({ sheet, url, title, leftOut, onChange }: Props) {
  const { frames, seconds } = sheet;
  const mayLeaveOut = frames.filter((frame) => !leftOut.includes(frame)).length > MIN_FRAMES;
  const toggle = (frame: number): void => {
    const next = leftOut.includes(frame) ? leftOut.filter((one) => one !== frame) : [...leftOut, frame];
    onChange(next.sort((one, other) => one - other));
  };
  return (
    <section class="panel frames" aria-label={title}>
      <h3>{title}</h3>
      <p class="hint">{words.framesHint}</p>
      <div class="frame-cells">
        {frames.map((frame, place) => {
          const out = leftOut.includes(frame);
          const last = seconds.at(-1) ?? 0;
          return (
            <button
              key={frame}
              type="button"
              aria-pressed={out}
              disabled={!out && !mayLeaveOut}
              aria-label={words.frame(place + 1, clock(seconds[place] ?? 0, last))}
              style={cellStyle(picturesOf(sheet), url, place)}
              onClick={() => toggle(frame)}
            />
          );
        })}
      </div>
      <div class="actions">
        <p class="hint" role="status">
          {leftOut.length > 0 && words.leftOut(leftOut.length)} {!mayLeaveOut && words.tooFew(MIN_FRAMES)}
        </p>
        {leftOut.length > 0 && (
          <button type="button" class="button quiet" onClick={() => onChange([])}>
            {words.framesBack}
          </button>
        )}
      </div>
    </section>
  );
}

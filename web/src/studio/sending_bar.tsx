/** How much of an order has been sent; it can be halted, taken up again, and given up. */

import { percent } from '../language/format';
import type { Names } from '../kind/kind';
import type { Sending } from '../sending/order';
import { plain, strings } from '../language/strings';

const words = strings.studio;

interface Props {
  /** Files, by what they are to the order; others are named as the order names them. */
  files: Names;
  step: Sending;
  paused: boolean;
  onPause: (on: boolean) => void;
  onStop: () => void;
}

export function SendingBar({ files, step, paused, onPause, onStop }: Props) {
  const ordering = step.step === 'ordering';
  const label = ordering
    ? words.ordering
    : (paused ? words.pausedAt : words.uploading)(partOf(step, files), percent(step.fraction));
  return (
    <div class="sending">
      <label>
        <span>{label}</span>
        <progress max="1" value={ordering ? undefined : step.fraction} />
      </label>
      {!ordering && (
        <button type="button" class="button" onClick={() => onPause(!paused)}>
          {paused ? words.resume : words.pause}
        </button>
      )}
      <button type="button" class="button" onClick={onStop}>
        {words.stop}
      </button>
    </div>
  );
}

function partOf({ part, place }: Sending & { step: 'uploading' }, files: Names): string {
  const name = files[part] ?? plain(part).toLowerCase();
  return place && place.count > 1 ? words.oneOf(name, place.number, place.count) : name;
}

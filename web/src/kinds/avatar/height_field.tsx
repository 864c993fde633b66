/** How tall the person is: written in centimetres or metres, shown as it is understood. */

import { useId } from 'preact/hooks';
import { heightIn } from './height';
import { words as avatarWords } from './words';

const words = avatarWords.studio;

interface Props {
  value: string;
  onChange: (text: string) => void;
}

export function HeightField({ value, onChange }: Props) {
  const id = useId();
  const metres = heightIn(value);
  const wrong = Number.isNaN(metres);
  return (
    <div class="field height">
      <label for={id}>
        {words.height}
        <output>{metres !== null && !wrong ? words.heightRead(metres.toFixed(2)) : words.heightUnit}</output>
      </label>
      <input
        id={id}
        type="text"
        inputMode="decimal"
        autoComplete="off"
        placeholder={words.heightExample}
        value={value}
        aria-invalid={wrong}
        aria-describedby={`${id}-hint`}
        onInput={({ currentTarget }) => onChange(currentTarget.value)}
      />
      <small id={`${id}-hint`} class={wrong ? 'error' : undefined}>
        {wrong ? words.heightWrong : words.heightHint}
      </small>
    </div>
  );
}

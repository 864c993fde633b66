/** How much of the picture is shown, how large, and as what kind of video. */

import { useId } from 'preact/hooks';
import { strings } from '../strings';
import type { Wishes } from './changes';

const words = strings.redo;
const sides = [512, 1024, 1920] as const;
const rates = [24, 25, 30, 50, 60] as const;
const formats = ['mp4', 'webm', 'webp'] as const;

interface Props<Value> {
  value: Value;
  onChange: (value: Value) => void;
}

export function CropField({ value, onChange }: Props<Wishes['crop']>) {
  const id = useId();
  const named = typeof value === 'string';
  return (
    <div class="field">
      <label for={id}>{words.crop}</label>
      <select
        id={id}
        value={named ? value : 'own'}
        onChange={({ currentTarget }) => onChange(currentTarget.value as 'none' | 'bust' | 'face')}
      >
        {!named && (
          <option value="own" disabled>
            {words.asBefore}
          </option>
        )}
        {(['none', 'bust', 'face'] as const).map((crop) => (
          <option key={crop} value={crop}>
            {words.crops[crop]}
          </option>
        ))}
      </select>
    </div>
  );
}

export function SizeField({ value, onChange }: Props<Wishes['size']>) {
  const id = useId();
  const side = value === null ? 0 : value[0] === value[1] ? value[0] : -1;
  const known = side === 0 || sides.some((one) => one === side);
  return (
    <div class="field">
      <label for={id}>{words.size}</label>
      <select
        id={id}
        value={known ? String(side) : 'own'}
        onChange={({ currentTarget }) => {
          const chosen = Number(currentTarget.value);
          onChange(chosen ? [chosen, chosen] : null);
        }}
      >
        {!known && (
          <option value="own" disabled>
            {words.asBefore}
          </option>
        )}
        <option value="0">{words.sizeOwn}</option>
        {sides.map((one) => (
          <option key={one} value={String(one)}>
            {words.sizeUpTo(one)}
          </option>
        ))}
      </select>
    </div>
  );
}

export function RateField({ value, onChange }: Props<Wishes['rate']>) {
  const id = useId();
  const known = value === null || rates.some((one) => one === value);
  return (
    <div class="field">
      <label for={id}>{words.rate}</label>
      <select
        id={id}
        value={known ? String(value ?? 0) : 'own'}
        onChange={({ currentTarget }) => onChange(Number(currentTarget.value) || null)}
      >
        {!known && (
          <option value="own" disabled>
            {words.asBefore}
          </option>
        )}
        <option value="0">{words.rateOwn}</option>
        {rates.map((one) => (
          <option key={one} value={String(one)}>
            {one}
          </option>
        ))}
      </select>
    </div>
  );
}

export function FormatField({ value, onChange }: Props<Wishes['format']>) {
  const id = useId();
  const known = formats.some((one) => one === value);
  return (
    <div class="field">
      <label for={id}>{words.format}</label>
      <select
        id={id}
        value={known ? value : 'own'}
        onChange={({ currentTarget }) => onChange(currentTarget.value as Wishes['format'])}
      >
        {!known && (
          <option value="own" disabled>
            {words.asBefore}
          </option>
        )}
        {formats.map((one) => (
          <option key={one} value={one}>
            {words.formats[one]}
          </option>
        ))}
      </select>
    </div>
  );
}

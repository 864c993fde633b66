/** Which part of the performance is used, and whose of those who are seen in it. */

import { useId } from 'preact/hooks';
import { words as portraitWords } from '../words';
import type { RevisionDraft } from './changes';

const words = portraitWords.corrections;
/** Seconds that a part has, at least. */
const SHORTEST = 0.1;

interface TrimProps {
  value: RevisionDraft['trim'];
  onChange: (trim: RevisionDraft['trim']) => void;
}

export function TrimField({ value: [start, end], onChange }: TrimProps) {
  const id = useId();
  const seconds = (input: HTMLInputElement): number | null => (input.value === '' ? null : input.valueAsNumber);
  return (
    <fieldset class="field" aria-describedby={id}>
      <legend>{words.trim}</legend>
      <div class="pair">
        <label>
          {words.trimFrom}
          <input
            type="number"
            min="0"
            step="any"
            value={start ?? ''}
            onChange={({ currentTarget }) => onChange([seconds(currentTarget), end])}
          />
        </label>
        <label>
          {words.trimTo}
          <input
            type="number"
            min={Math.round(((start ?? 0) + SHORTEST) * 1000) / 1000}
            step="any"
            required={start !== null}
            value={end ?? ''}
            onChange={({ currentTarget }) => onChange([start, seconds(currentTarget)])}
          />
        </label>
      </div>
      <small id={id}>{words.trimHint}</small>
    </fieldset>
  );
}

interface DriverFaceProps {
  /** How many faces the performance shows. */
  faces: number;
  value: number;
  onChange: (face: number) => void;
}

/** Nothing where there is one alone. */
export function DriverFaceField({ faces, value, onChange }: DriverFaceProps) {
  const id = useId();
  if (faces < 2) return null;
  return (
    <div class="field">
      <label for={id}>{words.driverFace}</label>
      <select id={id} value={String(value)} onChange={({ currentTarget }) => onChange(Number(currentTarget.value))}>
        {Array.from({ length: faces }, (_, face) => (
          <option key={face} value={String(face)}>
            {words.driverFaceNumber(face + 1, faces)}
          </option>
        ))}
      </select>
    </div>
  );
}

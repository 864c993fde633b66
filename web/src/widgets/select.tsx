/** One of a few things, from a list that unfolds. */

import { useId } from 'preact/hooks';
import { strings } from '../language/strings';

interface Props<Value, Choice extends Value> {
  label: string;
  hint?: string;
  /** One of the choices; where a job was made with another, the list says that it is as before. */
  value: Value;
  choices: readonly Choice[];
  nameOf: (choice: Choice) => string;
  onChange: (choice: Choice) => void;
}

export function SelectField<Value, Choice extends Value>({ label, hint, value, choices, nameOf, onChange }: Props<Value, Choice>) {
  const id = useId();
  const known = choices.findIndex((choice) => JSON.stringify(choice) === JSON.stringify(value));
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <select
        id={id}
        aria-describedby={hint ? `${id}-hint` : undefined}
        value={String(known)}
        onChange={({ currentTarget }) => onChange(choices[Number(currentTarget.value)]!)}
      >
        {known < 0 && (
          <option value="-1" disabled>
            {strings.redo.asBefore}
          </option>
        )}
        {choices.map((choice, index) => (
          <option key={index} value={String(index)}>
            {nameOf(choice)}
          </option>
        ))}
      </select>
      {hint && <small id={`${id}-hint`}>{hint}</small>}
    </div>
  );
}

/** The options of a portrait, and what of them is worth sending. */

import { useId } from 'preact/hooks';
import type { Part, PortraitOptions } from '../api';
import { strings } from '../strings';

export const parts: readonly Part[] = ['eyes', 'brows', 'mouth', 'head'];

export interface Choices {
  strength: number;
  follow: readonly Part[];
  sound: boolean;
}

export const usual: Choices = { strength: 1, follow: parts, sound: false };

/** The options to send: what differs from the usual, so that the service's own defaults hold elsewhere. */
export function optionsOf(choices: Choices, hasSound: boolean): PortraitOptions {
  return {
    ...(choices.strength !== usual.strength && { strength: choices.strength }),
    ...(choices.follow.length < parts.length && { follow: [...choices.follow] }),
    ...(choices.sound && hasSound && { sound: true }),
  };
}

interface Props {
  value: Choices;
  mayHaveSound: boolean;
  onChange: (choices: Choices) => void;
}

export function ChoiceFields({ value, mayHaveSound, onChange }: Props) {
  const strength = useId();
  const words = strings.studio;
  const toggle = (part: Part, on: boolean): void =>
    onChange({ ...value, follow: parts.filter((p) => (p === part ? on : value.follow.includes(p))) });

  return (
    <details class="choices">
      <summary>{words.options}</summary>
      <div class="fields">
        <div class="field">
          <label for={strength}>
            {words.strength} <output>{Math.round(value.strength * 100)}%</output>
          </label>
          <input
            id={strength}
            type="range"
            min="0"
            max="1.5"
            step="0.05"
            value={value.strength}
            aria-describedby={`${strength}-hint`}
            aria-valuetext={`${Math.round(value.strength * 100)}%`}
            onInput={(event) => onChange({ ...value, strength: event.currentTarget.valueAsNumber })}
          />
          <small id={`${strength}-hint`}>{words.strengthHint}</small>
        </div>
        <fieldset class="field">
          <legend>{words.follow}</legend>
          <div class="checks">
            {parts.map((part) => (
              <Check
                key={part}
                label={strings.parts[part]}
                checked={value.follow.includes(part)}
                // one part has to stay: nothing would move otherwise
                disabled={value.follow.length === 1 && value.follow.includes(part)}
                onChange={(on) => toggle(part, on)}
              />
            ))}
          </div>
        </fieldset>
        {mayHaveSound && (
          <div class="field">
            <Check label={words.sound} checked={value.sound} onChange={(sound) => onChange({ ...value, sound })} />
          </div>
        )}
      </div>
    </details>
  );
}

interface CheckProps {
  label: string;
  checked: boolean;
  disabled?: boolean;
  onChange: (on: boolean) => void;
}

function Check({ label, checked, disabled = false, onChange }: CheckProps) {
  return (
    <label class="check">
      <input
        type="checkbox"
        checked={checked}
        disabled={disabled}
        onChange={(event) => onChange(event.currentTarget.checked)}
      />
      <span>{label}</span>
    </label>
  );
}

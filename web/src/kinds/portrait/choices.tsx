/** The options of a portrait, and what of them is worth sending. */

import { useId } from 'preact/hooks';
import type { Part, PortraitOptions } from './types';
import { strings } from '../../language/strings';
import { Checkbox } from '../../widgets/checkbox';
import { words as portraitWords } from './words';

export const parts: readonly Part[] = ['eyes', 'brows', 'mouth', 'head'];

export interface Choices {
  strength: number;
  follow: readonly Part[];
  sound: boolean;
  /** Whether the end leads back to the beginning. */
  loop: boolean;
}

export const defaults: Choices = { strength: 1, follow: parts, sound: false, loop: false };

/** The options to send: what differs from the defaults, so that the service's own defaults hold elsewhere. */
export function optionsOf(choices: Choices, hasSound: boolean): PortraitOptions {
  return {
    ...(choices.strength !== defaults.strength && { strength: choices.strength }),
    ...(choices.follow.length < parts.length && { follow: [...choices.follow] }),
    ...(choices.sound && hasSound && { sound: true }),
    ...(choices.loop && { loop: true }),
  };
}

/** What a job was made with. */
export function choicesOf(options: PortraitOptions): Choices {
  return {
    strength: options.strength ?? defaults.strength,
    follow: options.follow ? parts.filter((part) => options.follow?.includes(part)) : defaults.follow,
    sound: options.sound ?? defaults.sound,
    loop: options.loop ?? defaults.loop,
  };
}

interface Props {
  value: Choices;
  mayHaveSound: boolean;
  onChange: (choices: Choices) => void;
}

/** The choices, folded away until somebody looks for them. */
export function FoldedChoices(props: Props) {
  return (
    <details class="choices">
      <summary>{strings.studio.options}</summary>
      <div class="fields">
        <ChoiceFields {...props} />
      </div>
    </details>
  );
}

export function ChoiceFields({ value, mayHaveSound, onChange }: Props) {
  const strength = useId();
  const words = portraitWords.studio;
  const toggle = (part: Part, on: boolean): void =>
    onChange({ ...value, follow: parts.filter((p) => (p === part ? on : value.follow.includes(p))) });

  return (
    <>
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
            <Checkbox
              key={part}
              label={portraitWords.parts[part]}
              checked={value.follow.includes(part)}
              // one part has to stay: nothing would move otherwise
              disabled={value.follow.length === 1 && value.follow.includes(part)}
              onChange={(on) => toggle(part, on)}
            />
          ))}
        </div>
      </fieldset>
      <div class="field">
        <Checkbox label={words.loop} checked={value.loop} onChange={(loop) => onChange({ ...value, loop })} />
        {mayHaveSound && (
          <Checkbox label={words.sound} checked={value.sound} onChange={(sound) => onChange({ ...value, sound })} />
        )}
      </div>
    </>
  );
}

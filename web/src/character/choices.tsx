/** The options of a character, and what of them is worth sending. */

import { useId } from 'preact/hooks';
import type { BodyPart, CharacterOptions } from '../api';
import { Check } from '../components/check';
import { duration } from '../format';
import { strings } from '../strings';

const words = strings.character;

export const bodyParts: readonly BodyPart[] = ['head', 'torso', 'left_arm', 'right_arm', 'left_leg', 'right_leg'];
/** Names that stand for two parts. */
const both: Partial<Record<string, readonly BodyPart[]>> = {
  arms: ['left_arm', 'right_arm'],
  legs: ['left_leg', 'right_leg'],
};
const cameras = ['fixed', 'orbit', 'parallax'] as const;
const backs = ['mirror', 'inpaint'] as const;

export interface Choices {
  keep: readonly BodyPart[];
  camera: (typeof cameras)[number];
  seconds: number;
  back: (typeof backs)[number];
  partial: boolean;
  /** A picture of the character under lamps. */
  lit: boolean;
  vrm: boolean;
  /** Whose the character is, for its VRM file; empty where nobody says. */
  author: string;
}

export const usual: Choices = {
  keep: [],
  camera: 'fixed',
  seconds: 4,
  back: 'mirror',
  partial: false,
  lit: false,
  vrm: false,
  author: '',
};

/** The options to send: what differs from the usual, so that the service's own defaults hold elsewhere. */
export const optionsOf = (choices: Choices): CharacterOptions => changedOptions(usual, choices) as CharacterOptions;

/** The options that tell one choice from another; null where the usual is wanted again. */
export function changedOptions(before: Choices, now: Choices): { [Name in keyof CharacterOptions]?: unknown } {
  const keep = bodyParts.filter((part) => now.keep.includes(part));
  const kept = bodyParts.filter((part) => before.keep.includes(part));
  return {
    ...(keep.join() !== kept.join() && { keep: keep.length ? keep : null }),
    ...(now.camera !== before.camera && { camera: now.camera === usual.camera ? null : now.camera }),
    ...(now.seconds !== before.seconds && { seconds: now.seconds === usual.seconds ? null : now.seconds }),
    ...(now.back !== before.back && { back_texture: now.back === usual.back ? null : now.back }),
    ...(now.partial !== before.partial && { partial: now.partial || null }),
    ...(now.lit !== before.lit && { lit: now.lit || null }),
    ...(now.vrm !== before.vrm && { vrm: now.vrm || null }),
    ...(now.author.trim() !== before.author && { vrm_author: now.author.trim() || null }),
  };
}

/** What a job was made with. */
export function choicesOf(options: CharacterOptions): Choices {
  const kept = new Set((options.keep ?? []).flatMap((name) => both[name] ?? [name as BodyPart]));
  return {
    keep: bodyParts.filter((part) => kept.has(part)),
    camera: options.camera ?? usual.camera,
    seconds: options.seconds ?? usual.seconds,
    back: options.back_texture ?? usual.back,
    partial: options.partial ?? usual.partial,
    lit: options.lit ?? usual.lit,
    vrm: options.vrm ?? usual.vrm,
    author: options.vrm_author ?? usual.author,
  };
}

interface Props {
  value: Choices;
  onChange: (part: Partial<Choices>) => void;
}

export function KeepField({ value, onChange }: Props) {
  const toggle = (part: BodyPart, on: boolean): void =>
    onChange({ keep: bodyParts.filter((one) => (one === part ? on : value.keep.includes(one))) });
  return (
    <fieldset class="field">
      <legend>{words.keep}</legend>
      <div class="checks">
        {bodyParts.map((part) => (
          <Check
            key={part}
            label={words.parts[part]}
            checked={value.keep.includes(part)}
            // one part has to go: nothing would move otherwise
            disabled={value.keep.length === bodyParts.length - 1 && !value.keep.includes(part)}
            onChange={(on) => toggle(part, on)}
          />
        ))}
      </div>
      <small>{words.partsHint}</small>
    </fieldset>
  );
}

export function VideoFields({ value, onChange }: Props) {
  const id = useId();
  return (
    <>
      <div class="field">
        <label for={`${id}-camera`}>{words.camera}</label>
        <select
          id={`${id}-camera`}
          value={value.camera}
          onChange={({ currentTarget }) => onChange({ camera: currentTarget.value as Choices['camera'] })}
        >
          {cameras.map((camera) => (
            <option key={camera} value={camera}>
              {words.cameras[camera]}
            </option>
          ))}
        </select>
      </div>
      <div class="field">
        <label for={`${id}-seconds`}>
          {words.seconds} <output>{duration(value.seconds)}</output>
        </label>
        <input
          id={`${id}-seconds`}
          type="range"
          min="1"
          max="30"
          step="1"
          value={value.seconds}
          aria-valuetext={duration(value.seconds)}
          onInput={({ currentTarget }) => onChange({ seconds: currentTarget.valueAsNumber })}
        />
      </div>
      <div class="field">
        <label for={`${id}-back`}>{words.back}</label>
        <select
          id={`${id}-back`}
          value={value.back}
          onChange={({ currentTarget }) => onChange({ back: currentTarget.value as Choices['back'] })}
        >
          {backs.map((back) => (
            <option key={back} value={back}>
              {words.backs[back]}
            </option>
          ))}
        </select>
      </div>
      <div class="field">
        <Check label={words.partial} checked={value.partial} onChange={(partial) => onChange({ partial })} />
        <Check label={words.lit} checked={value.lit} onChange={(lit) => onChange({ lit })} />
        <Check label={words.vrm} checked={value.vrm} onChange={(vrm) => onChange({ vrm })} />
      </div>
      {value.vrm && (
        <div class="field">
          <label for={`${id}-author`}>{words.author}</label>
          <input
            id={`${id}-author`}
            type="text"
            maxLength={200}
            value={value.author}
            placeholder={words.usualAuthor}
            onInput={({ currentTarget }) => onChange({ author: currentTarget.value })}
          />
        </div>
      )}
    </>
  );
}

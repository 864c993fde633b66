/** The options of a character, and what of them is worth sending. */

import { useId } from 'preact/hooks';
import type { BodyPart, CharacterOptions } from './types';
import { Checkbox } from '../../widgets/checkbox';
import { SelectField } from '../../widgets/select';
import { type Format, FormatField, RateField, type Size, SizeField } from '../../studio/video_fields';
import { count, duration } from '../../language/format';
import { words as characterWords } from './words';

const words = characterWords.character;

export const bodyParts: readonly BodyPart[] = ['head', 'torso', 'left_arm', 'right_arm', 'left_leg', 'right_leg'];
/** Names that stand for two parts. */
const both: Partial<Record<string, readonly BodyPart[]>> = {
  arms: ['left_arm', 'right_arm'],
  legs: ['left_leg', 'right_leg'],
};
const cameras = ['fixed', 'orbit', 'parallax'] as const;
const backs = ['see_through', 'mirror', 'inpaint'] as const;
const surfaces = ['auto', 'hybrid', 'relief', 'shell'] as const;
const triangles = [10_000, 30_000, 60_000, 120_000, 200_000] as const;
const levels = [0, 1, 2, 3] as const;

export interface Choices {
  keep: readonly BodyPart[];
  camera: (typeof cameras)[number];
  seconds: number;
  size: Size;
  /** Frames a second. */
  rate: number;
  format: Format;
  surface: (typeof surfaces)[number];
  back: (typeof backs)[number];
  /** Of the character, at most. */
  triangles: number;
  /** How many coarser copies of it there are, too. */
  levels: number;
  partial: boolean;
  /** A picture of the character under lamps. */
  lit: boolean;
  vrm: boolean;
  /** Whose the character is, for its VRM file; empty where nobody says. */
  author: string;
}

export const defaults: Choices = {
  keep: [],
  camera: 'fixed',
  seconds: 4,
  size: null,
  rate: 30,
  format: 'mp4',
  surface: 'auto',
  back: 'see_through',
  triangles: 60_000,
  levels: 0,
  partial: false,
  lit: false,
  vrm: false,
  author: '',
};

/** The options to send: what differs from the defaults, so that the service's own defaults hold elsewhere. */
export const optionsOf = (choices: Choices): CharacterOptions => changedOptions(defaults, choices) as CharacterOptions;

/** The options that tell one choice from another; null where the default is wanted again. */
export function changedOptions(before: Choices, now: Choices): { [Name in keyof CharacterOptions]?: unknown } {
  const keep = bodyParts.filter((part) => now.keep.includes(part));
  const kept = bodyParts.filter((part) => before.keep.includes(part));
  return {
    ...(keep.join() !== kept.join() && { keep: keep.length ? keep : null }),
    ...(now.camera !== before.camera && { camera: now.camera === defaults.camera ? null : now.camera }),
    ...(now.seconds !== before.seconds && { seconds: now.seconds === defaults.seconds ? null : now.seconds }),
    ...(now.size?.join() !== before.size?.join() && { size: now.size }),
    ...(now.rate !== before.rate && { fps: now.rate === defaults.rate ? null : now.rate }),
    ...(now.format !== before.format && { format: now.format === defaults.format ? null : now.format }),
    ...(now.surface !== before.surface && { surface: now.surface === defaults.surface ? null : now.surface }),
    ...(now.back !== before.back && { back_texture: now.back === defaults.back ? null : now.back }),
    ...(now.triangles !== before.triangles && { triangles: now.triangles === defaults.triangles ? null : now.triangles }),
    ...(now.levels !== before.levels && { levels: now.levels || null }),
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
    camera: options.camera ?? defaults.camera,
    seconds: options.seconds ?? defaults.seconds,
    size: options.size ?? defaults.size,
    rate: options.fps ?? defaults.rate,
    format: options.format ?? defaults.format,
    surface: options.surface ?? defaults.surface,
    back: options.back_texture ?? defaults.back,
    triangles: options.triangles ?? defaults.triangles,
    levels: options.levels ?? defaults.levels,
    partial: options.partial ?? defaults.partial,
    lit: options.lit ?? defaults.lit,
    vrm: options.vrm ?? defaults.vrm,
    author: options.vrm_author ?? defaults.author,
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
    <fieldset class="field whole">
      <legend>{words.keep}</legend>
      <div class="checks">
        {bodyParts.map((part) => (
          <Checkbox
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
      <SelectField
        label={words.camera}
        value={value.camera}
        choices={cameras}
        nameOf={(camera) => words.cameras[camera]}
        onChange={(camera) => onChange({ camera })}
      />
      <div class="field">
        <label for={id}>
          {words.seconds} <output>{duration(value.seconds)}</output>
        </label>
        <input
          id={id}
          type="range"
          min="1"
          max="30"
          step="1"
          value={value.seconds}
          aria-valuetext={duration(value.seconds)}
          onInput={({ currentTarget }) => onChange({ seconds: currentTarget.valueAsNumber })}
        />
      </div>
      <SizeField value={value.size} own={words.sizeOwn} onChange={(size) => onChange({ size })} />
      <RateField value={value.rate} onChange={(rate) => onChange({ rate: rate ?? defaults.rate })} />
      <FormatField value={value.format} onChange={(format) => onChange({ format })} />
    </>
  );
}

/** The character itself: its back, how fine it is, and what else there is of it. */
export function CharacterFields({ value, onChange }: Props) {
  const id = useId();
  return (
    <>
      <SelectField
        label={words.surface}
        value={value.surface}
        choices={surfaces}
        nameOf={(surface) => words.surfaces[surface]}
        onChange={(surface) => onChange({ surface })}
      />
      <SelectField
        label={words.back}
        value={value.back}
        choices={backs}
        nameOf={(back) => words.backs[back]}
        onChange={(back) => onChange({ back })}
      />
      <SelectField
        label={words.triangles}
        value={value.triangles}
        choices={triangles}
        nameOf={count}
        onChange={(most) => onChange({ triangles: most })}
      />
      <SelectField
        label={words.levels}
        value={value.levels}
        choices={levels}
        nameOf={(level) => (level === 0 ? words.noLevels : count(level))}
        onChange={(level) => onChange({ levels: level })}
      />
      <div class="field whole">
        <div class="checks">
          <Checkbox label={words.partial} checked={value.partial} onChange={(partial) => onChange({ partial })} />
          <Checkbox label={words.lit} checked={value.lit} onChange={(lit) => onChange({ lit })} />
          <Checkbox label={words.vrm} checked={value.vrm} onChange={(vrm) => onChange({ vrm })} />
        </div>
      </div>
      {value.vrm && (
        <div class="field whole">
          <label for={id}>{words.author}</label>
          <input
            id={id}
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

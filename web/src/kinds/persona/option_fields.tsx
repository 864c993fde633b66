/** What may be chosen of the picture and the video, folded away. */

import { useId } from 'preact/hooks';
import { useDescriptions } from '../../kind/offered';
import { Checkbox } from '../../widgets/checkbox';
import { FileButton } from '../../widgets/file_button';
import { SelectField } from '../../widgets/select';
import { OptionFields, type Options } from '../generic/fields';
import { type Field, fieldsOf } from '../generic/schema';
import { colourOf, hexOf } from './colour';
import { isPuppet } from './composite_field';
import { words as personaWords } from './words';

const words = personaWords.studio;
const sizes = ['600x800', '900x1200', '800x800', '1280x720'] as const;
const [usualSize] = sizes;
/** What the service has where nothing is said. */
const USUAL_BACKGROUND = [58, 60, 64] as const;

interface Props {
  value: Options;
  mayHaveSound: boolean;
  /** What the puppet stands before, instead of a plain colour; undefined where that is not asked. */
  backdrop?: File | null;
  onBackdrop?: (backdrop: File | null) => void;
  onChange: (options: Options) => void;
}

export function PersonaOptionFields({ value, mayHaveSound, backdrop, onBackdrop, onChange }: Props) {
  const id = useId();
  const description = useDescriptions()?.find(({ name }) => name === 'persona');
  const others = fieldsOf(description?.options_schema ?? {}).flatMap((field): Field[] => {
    const label = words.options[field.name]; // what has no word here is asked for elsewhere
    return label ? [{ ...field, label }] : [];
  });
  const set = (name: string, wanted: unknown): void => {
    const { [name]: _before, ...kept } = value;
    onChange(wanted === undefined ? kept : { ...kept, [name]: wanted });
  };
  const size = Array.isArray(value.size) ? value.size.join('x') : usualSize;
  return (
    <div class="fields paired">
      <SelectField
        label={words.videoSize}
        value={size}
        choices={(sizes as readonly string[]).includes(size) ? sizes : [...sizes, size]}
        nameOf={(one) => words.videoSizes[one] ?? one}
        onChange={(one) => set('size', one === usualSize ? undefined : one.split('x').map(Number))}
      />
      {isPuppet(String(value.composite)) && (
        <div class="field">
          <label for={id}>{words.background}</label>
          <input
            id={id}
            type="color"
            value={hexOf((value.background as readonly number[] | undefined) ?? USUAL_BACKGROUND)}
            onInput={({ currentTarget }) => set('background', colourOf(currentTarget.value))}
          />
          {onBackdrop && (
            <div class="actions">
              <FileButton label={backdrop?.name ?? words.backdrop.choose} name={words.backdrop.name} accept="image/*" onFile={onBackdrop} />
              {backdrop && (
                <button type="button" class="button quiet" onClick={() => onBackdrop(null)}>
                  {words.backdrop.without}
                </button>
              )}
            </div>
          )}
        </div>
      )}
      <OptionFields fields={others} value={value} onChange={onChange} />
      {mayHaveSound && (
        <div class="field">
          <Checkbox label={words.sound} checked={value.sound === true} onChange={(on) => set('sound', on || undefined)} />
        </div>
      )}
    </div>
  );
}

/** A form for options, as their schema wants it. What is left alone is not sent, so that the service's defaults hold. */

import { useId } from 'preact/hooks';
import { plain, strings } from '../../language/strings';
import { Checkbox } from '../../widgets/checkbox';
import { SelectField } from '../../widgets/select';
import type { Field } from './schema';

const words = strings.generic;

export type Options = Readonly<Record<string, unknown>>;

interface Props {
  fields: readonly Field[];
  value: Options;
  onChange: (options: Options) => void;
}

export function OptionFields({ fields, value, onChange }: Props) {
  const set = (name: string, wanted: unknown): void => {
    const { [name]: _before, ...others } = value;
    onChange(wanted === undefined ? others : { ...others, [name]: wanted });
  };
  return (
    <>
      {fields.map((field) => (
        <OptionField key={field.name} field={field} value={value[field.name]} onChange={(wanted) => set(field.name, wanted)} />
      ))}
    </>
  );
}

interface FieldProps {
  field: Field;
  /** Undefined: left alone. */
  value: unknown;
  onChange: (value: unknown) => void;
}

function OptionField({ field, value, onChange }: FieldProps) {
  const { label, hint, usual } = field;
  switch (field.type) {
    case 'switch':
      return (
        <div class="field">
          <Checkbox label={label} checked={(value ?? usual) === true} onChange={(on) => onChange(on === usual ? undefined : on)} />
          {hint && <small>{hint}</small>}
        </div>
      );
    case 'choice':
      return (
        <SelectField
          label={label}
          hint={hint}
          value={value}
          choices={[undefined, ...field.choices]}
          nameOf={(choice) => nameOf(choice, usual)}
          onChange={onChange}
        />
      );
    case 'several': {
      const chosen = (value ?? usual ?? []) as unknown[];
      const toggle = (one: unknown, on: boolean): void =>
        onChange(field.choices.filter((choice) => (choice === one ? on : chosen.includes(choice))));
      return (
        <fieldset class="field">
          <legend>{label}</legend>
          <div class="checks">
            {field.choices.map((choice) => (
              <Checkbox
                key={choice}
                label={nameOf(choice, null)}
                checked={chosen.includes(choice)}
                onChange={(on) => toggle(choice, on)}
              />
            ))}
          </div>
          {hint && <small>{hint}</small>}
        </fieldset>
      );
    }
    default:
      return <TypedField field={field} value={value} onChange={onChange} />;
  }
}

function nameOf(choice: unknown, usual: unknown): string {
  if (choice === undefined) return usual === null ? words.usual : `${words.usual}: ${nameOf(usual, null)}`;
  if (typeof choice === 'boolean') return choice ? words.yes : words.no;
  return typeof choice === 'string' ? plain(choice) : JSON.stringify(choice);
}

/** What is typed: a number, a text, or JSON. */
function TypedField({ field, value, onChange }: FieldProps) {
  const id = useId();
  const { label, hint, usual } = field;
  const json = field.type === 'json';
  const shown = value === undefined ? '' : json ? undefined : String(value);
  const type = (input: HTMLInputElement | HTMLTextAreaElement): void => {
    input.setCustomValidity('');
    if (input.value.trim() === '') onChange(undefined);
    else if (field.type === 'number') onChange((input as HTMLInputElement).valueAsNumber);
    else if (!json) onChange(input.value);
    else {
      try {
        onChange(JSON.parse(input.value));
      } catch {
        input.setCustomValidity(words.wrongJson);
      }
    }
  };
  const common = {
    id,
    placeholder: usual === null ? '' : json ? JSON.stringify(usual) : String(usual),
    'aria-describedby': `${id}-hint`,
  };
  return (
    <div class="field">
      <label for={id}>{label}</label>
      {json ? (
        <textarea {...common} rows={2} onInput={({ currentTarget }) => type(currentTarget)} />
      ) : field.type === 'number' ? (
        <input
          {...common}
          type="number"
          min={field.min ?? undefined}
          max={field.max ?? undefined}
          step={field.whole ? 1 : 'any'}
          value={shown}
          onInput={({ currentTarget }) => type(currentTarget)}
        />
      ) : (
        <input {...common} type="text" value={shown} onInput={({ currentTarget }) => type(currentTarget)} />
      )}
      <small id={`${id}-hint`}>{[hint, json ? words.json : ''].filter(Boolean).join(' ')}</small>
    </div>
  );
}

/** What may be chosen besides, folded away: the service's own options, in the page's words. */

import { useDescriptions } from '../../kind/offered';
import { SelectField } from '../../widgets/select';
import { OptionFields, type Options } from '../generic/fields';
import { type Field, fieldsOf } from '../generic/schema';
import { words as avatarWords } from './words';

const words = avatarWords.studio;
const sizes = ['720x1280', '1080x1920', '1280x720', '1080x1080'] as const;
const [usualSize] = sizes;

interface Props {
  value: Options;
  onChange: (options: Options) => void;
}

export function AvatarOptionFields({ value, onChange }: Props) {
  const description = useDescriptions()?.find(({ name }) => name === 'avatar');
  const fields = fieldsOf(description?.options_schema ?? {}).flatMap((field): Field[] => {
    const label = words.options[field.name]; // what has no word here is asked for elsewhere
    return label ? [{ ...field, label }] : [];
  });
  const size = Array.isArray(value.size) ? value.size.join('x') : usualSize;
  const setSize = (wanted: string): void => {
    const { size: _before, ...others } = value;
    onChange(wanted === usualSize ? others : { ...others, size: wanted.split('x').map(Number) });
  };
  return (
    <div class="fields paired">
      <OptionFields fields={fields} value={value} onChange={onChange} />
      <SelectField
        label={words.videoSize}
        value={size}
        choices={(sizes as readonly string[]).includes(size) ? sizes : [...sizes, size]}
        nameOf={(one) => words.videoSizes[one] ?? one}
        onChange={setSize}
      />
    </div>
  );
}

/** What is seen of a persona: its face alone, or the person as one of the photos shows them. */

import { useDescriptions } from '../../kind/offered';
import { plain } from '../../language/strings';
import { fieldsOf } from '../generic/schema';
import { words as personaWords } from './words';

const words = personaWords.studio;
/** What the service has where nothing is said. */
export const USUAL_COMPOSITE = 'none';
/** What most people want: the person, where the photos allow it. */
export const BEST_COMPOSITE = 'photo';

/** In the order in which they are offered; what the service has besides comes last. */
const known = Object.keys(words.composites);

interface Props {
  value: string;
  /** Of a picture as the performance, what shows the face alone. */
  still: boolean;
  onChange: (composite: string) => void;
}

export function CompositeField({ value, still, onChange }: Props) {
  const choices = useComposites().filter((one) => !still || one !== BEST_COMPOSITE);
  if (choices.length < 2) return null;
  return (
    <fieldset class="field composites">
      <legend>{words.composite}</legend>
      <div class="actions">
        {choices.map((one) => (
          <button key={one} type="button" class="toggle" aria-pressed={one === value} onClick={() => onChange(one)}>
            {words.composites[one] ?? plain(one)}
          </button>
        ))}
      </div>
    </fieldset>
  );
}

/** Those that the service has. */
export function useComposites(): readonly string[] {
  const description = useDescriptions()?.find(({ name }) => name === 'persona');
  const field = fieldsOf(description?.options_schema ?? {}).find(({ name }) => name === 'composite');
  const choices = field?.type === 'choice' ? field.choices.map(String) : [];
  return [...known.filter((one) => choices.includes(one)), ...choices.filter((one) => !known.includes(one))];
}

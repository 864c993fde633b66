/** What is seen of a persona: its face alone, or the person as one of the photos shows them. */

import { useDescriptions } from '../../kind/offered';
import { plain } from '../../language/strings';
import { fieldsOf } from '../generic/schema';
import { Toggles } from '../../widgets/toggles';
import { words as personaWords } from './words';

const words = personaWords.studio;
/** What the service has where nothing is said. */
export const USUAL_COMPOSITE = 'auto';
/** Those in which a photo acts, 'auto' where one can. */
export const actsByPhoto = (composite: string): boolean => composite === 'photo' || composite === USUAL_COMPOSITE;

/** Those in which the puppet is seen, alone or beside the performer. */
export const isPuppet = (composite: string): boolean => !actsByPhoto(composite);

/** In the order in which they are offered; what the service has besides comes last. */
const known = Object.keys(words.composites);

interface Props {
  value: string;
  onChange: (composite: string) => void;
}

export function CompositeField({ value, onChange }: Props) {
  const choices = useComposites();
  if (choices.length < 2) return null;
  return (
    <fieldset class="field composites">
      <legend>{words.composite}</legend>
      <Toggles choices={choices} name={(one) => words.composites[one] ?? plain(one)} chosen={value} onChoose={onChange} />
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

/** Which of the people who were woken is meant, or all of them. */

import { words } from './words';
import { Toggles } from '../widgets/toggles';
import type { CharacterFiles } from './artifacts/people';

/** The place in their row. */
export type PersonChoice = number | 'all';

interface Props {
  people: readonly CharacterFiles[];
  /** Whether all can be chosen. */
  together: boolean;
  chosen: PersonChoice;
  disabled?: boolean;
  onChoose: (who: PersonChoice) => void;
}

export function PersonSelect({ people, together, chosen, disabled = false, onChoose }: Props) {
  const offered: PersonChoice[] = [...(together ? ['all' as const] : []), ...people.keys()];
  return (
    <Toggles
      label={words.people}
      choices={offered}
      name={(who) => (who === 'all' ? words.everybody : words.person(people[who]?.number ?? who + 1))}
      chosen={chosen}
      disabled={disabled}
      class="viewer-people"
      onChoose={onChoose}
    />
  );
}

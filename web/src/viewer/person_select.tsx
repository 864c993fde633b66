/** Which of the people who were woken is meant, or all of them. */

import { words } from './words';
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
    <div class="actions viewer-people" role="group" aria-label={words.people}>
      {offered.map((who) => (
        <button
          key={who}
          type="button"
          class="toggle"
          aria-pressed={who === chosen}
          disabled={disabled}
          onClick={() => onChoose(who)}
        >
          {who === 'all' ? words.everybody : words.person(people[who]?.number ?? who + 1)}
        </button>
      ))}
    </div>
  );
}

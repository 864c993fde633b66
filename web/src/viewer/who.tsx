/** Which of the people who were woken is meant, or all of them. */

import { strings } from '../strings';
import type { WokenPerson } from './people';

const words = strings.viewer;

/** The place in their row. */
export type Who = number | 'all';

interface Props {
  people: readonly WokenPerson[];
  /** Whether all can be chosen. */
  together: boolean;
  chosen: Who;
  disabled?: boolean;
  onChoose: (who: Who) => void;
}

export function WhoChoice({ people, together, chosen, disabled = false, onChoose }: Props) {
  const offered: Who[] = [...(together ? ['all' as const] : []), ...people.keys()];
  return (
    <div class="actions viewer-who" role="group" aria-label={words.who}>
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

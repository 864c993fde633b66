/** What a portrait can be given besides a performance: the one that fits it best, or all of them on demand. */

import { AUTO } from '../../performances/drivers';
import { SymbolCard } from '../../studio/symbol_card';
import type { Performance } from './order';
import { words as portraitWords } from './words';

const words = portraitWords.studio;

/** Drawings of what has no picture: paths in a square of 48. */
const symbols = {
  stars:
    'M20 12c1.5 8 4.5 11 12 12-7.5 1-10.5 4-12 12-1.5-8-4.5-11-12-12 7.5-1 10.5-4 12-12m15-3c.6 3.5 1.9 4.8 5 5-3.1.6-4.4 1.9-5 5-.6-3.1-1.9-4.4-5-5 3.1-.2 4.4-1.5 5-5',
  touch:
    'M19 40c-3-5-6-9-8-12 2-3 5-1 8 2V12c0-4 5-4 5 0v11l9 2c3 1 4 3 3 6l-3 9M11 12a10 10 0 0 1 5-8m11 0a10 10 0 0 1 5 8',
};

interface Props {
  chosen: Performance | null;
  onChoose: (performance: Performance) => void;
}

export function SpecialCards({ chosen, onChoose }: Props) {
  return (
    <>
      <SymbolCard
        value={AUTO}
        symbol={symbols.stars}
        label={words.auto}
        hint={words.autoHint}
        checked={chosen?.by === 'name' && chosen.name === AUTO}
        onChoose={() => onChoose({ by: 'name', name: AUTO })}
      />
      <SymbolCard
        value="reactive"
        symbol={symbols.touch}
        label={words.reactive}
        hint={words.reactiveHint}
        checked={chosen?.by === 'reactive'}
        onChoose={() => onChoose({ by: 'reactive' })}
      />
    </>
  );
}

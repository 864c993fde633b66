/** What can be made here, each with a page of its own. */

import { characterLink, studioLink } from '../route';
import { strings } from '../strings';

const words = strings.make;

export function Making({ kind }: { kind: 'portrait' | 'character' }) {
  return (
    <nav class="making" aria-label={words.label}>
      <a href={studioLink} aria-current={kind === 'portrait' ? 'page' : undefined}>
        {words.portrait}
      </a>
      <a href={characterLink} aria-current={kind === 'character' ? 'page' : undefined}>
        {words.character}
      </a>
    </nav>
  );
}

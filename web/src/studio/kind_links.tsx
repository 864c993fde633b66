/** What can be made here, each with a page of its own. */

import { strings } from '../language/strings';
import { useOffered } from '../kind/offered';

export function KindLinks({ current }: { current: string }) {
  return (
    <nav class="kind-links" aria-label={strings.make.label}>
      {useOffered().map(({ name, label, link }) => (
        <a key={name} href={link} aria-current={name === current ? 'page' : undefined}>
          {label}
        </a>
      ))}
    </nav>
  );
}

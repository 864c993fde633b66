/** An address at which there is no page. */

import { Heading } from '../widgets/heading';
import { strings } from '../language/strings';

const words = strings.lost;

export function LostPage() {
  return (
    <article class="lost">
      <Heading text={words.title} />
      <p>{words.detail}</p>
      <a class="button primary" href="/">
        {words.home}
      </a>
    </article>
  );
}

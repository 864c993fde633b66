/** What makes a collection good, and what of it is not used. */

import { words as personaWords } from '../words';

const words = personaWords.studio;

export function Advice() {
  return (
    <section class="panel" aria-label={words.helpsTitle}>
      <h2>{words.helpsTitle}</h2>
      <ul class="advice">
        {words.helps.map((help) => (
          <li key={help}>{help}</li>
        ))}
      </ul>
      <p class="hint">
        <strong>{words.failsTitle}:</strong> {words.fails}
      </p>
    </section>
  );
}

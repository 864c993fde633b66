/** What helps when clips are filmed, and what made others fail. */

import { words as avatarWords } from '../words';

const words = avatarWords.studio;

export function Advice() {
  return (
    <section class="panel" aria-label={words.failsTitle}>
      <h2>{words.failsTitle}</h2>
      <ul class="fails">
        {words.fails.map((reason) => (
          <li key={reason}>{reason}</li>
        ))}
      </ul>
      <p class="hint">
        <strong>{words.helpsTitle}:</strong> {words.helps}
      </p>
    </section>
  );
}

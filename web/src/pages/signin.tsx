/** Where the service wants to know who comes: a key is given once, then the browser is known for some hours. */

import { useId, useState } from 'preact/hooks';
import { openSession } from '../api';
import { Heading } from '../widgets/heading';
import { ProblemAlert } from '../widgets/problem_alert';
import { useDoing } from '../api/loading';
import { strings } from '../language/strings';

const words = strings.signIn;

export function SignInPage({ onOpen }: { onOpen: () => void }) {
  const id = useId();
  const [key, setKey] = useState('');
  const { doing, problem, attempt } = useDoing();
  return (
    <form
      class="sign-in panel"
      onSubmit={(event) => {
        event.preventDefault();
        void attempt(async () => {
          await openSession(key.trim());
          onOpen();
        });
      }}
    >
      <Heading text={words.title} />
      <p class="hint">{words.hint}</p>
      <div class="field">
        <label for={id}>{words.key}</label>
        <input
          id={id}
          type="password"
          autocomplete="current-password"
          required
          value={key}
          onInput={({ currentTarget }) => setKey(currentTarget.value)}
        />
      </div>
      {problem && <ProblemAlert code={problem.code} detail={problem.detail} />}
      <button type="submit" class="button primary" disabled={doing || !key.trim()}>
        {words.open}
      </button>
    </form>
  );
}

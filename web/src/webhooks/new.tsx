/** A new address to be told. */

import { useId, useState } from 'preact/hooks';
import { createWebhook, type NewWebhook, type WebhookEvent } from '../api';
import { ProblemAlert } from '../widgets/problem_alert';
import { useDoing } from '../api/loading';
import { strings } from '../language/strings';

const words = strings.webhooks;
const events: readonly WebhookEvent[] = ['job.succeeded', 'job.failed', 'job.canceled', 'job.progress'];

export function NewEndpoint({ onMade }: { onMade: (webhook: NewWebhook) => void }) {
  const id = useId();
  const [url, setUrl] = useState('');
  const [chosen, setChosen] = useState<readonly WebhookEvent[]>(events.slice(0, 3));
  const { doing, problem, attempt } = useDoing();
  return (
    <form
      class="panel"
      aria-label={words.newTitle}
      onSubmit={(event) => {
        event.preventDefault();
        void attempt(async () => {
          onMade(await createWebhook(url.trim(), [...chosen]));
          setUrl('');
        });
      }}
    >
      <h2>{words.newTitle}</h2>
      <div class="field">
        <label for={id}>{words.url}</label>
        <input
          id={id}
          type="url"
          required
          placeholder="https://shop.example/galatea"
          value={url}
          onInput={({ currentTarget }) => setUrl(currentTarget.value)}
        />
      </div>
      <fieldset class="field">
        <legend>{words.events}</legend>
        <div class="checks">
          {events.map((one) => (
            <label key={one} class="check">
              <input
                type="checkbox"
                checked={chosen.includes(one)}
                onChange={({ currentTarget }) =>
                  setChosen(events.filter((other) => (other === one ? currentTarget.checked : chosen.includes(other))))
                }
              />
              <span>{words.eventNames[one]}</span>
            </label>
          ))}
        </div>
      </fieldset>
      {problem && <ProblemAlert code={problem.code} detail={problem.detail} />}
      <button type="submit" class="button primary" disabled={doing || !url.trim() || chosen.length === 0}>
        {words.create}
      </button>
    </form>
  );
}

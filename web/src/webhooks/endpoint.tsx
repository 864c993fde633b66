/** An address that is told: its state, its secret, and what can be done with it. */

import { useState } from 'preact/hooks';
import {
  deleteWebhook,
  enableWebhook,
  getWebhookSecret,
  rotateWebhookSecret,
  testWebhook,
  type Webhook,
  type WebhookSecret,
} from '../api';
import { Copyable } from '../widgets/copyable';
import { ConfirmButton } from '../widgets/confirm';
import { ProblemAlert } from '../widgets/problem_alert';
import { ago, moment } from '../language/format';
import { useDoing } from '../api/loading';
import { strings } from '../language/strings';

const words = strings.webhooks;

export function Endpoint({ webhook, onChange }: { webhook: Webhook; onChange: () => void }) {
  const [secret, setSecret] = useState<WebhookSecret | null>(null);
  const { doing, problem, attempt } = useDoing();
  const act = (what: () => Promise<unknown>): void =>
    void attempt(async () => {
      await what();
      onChange();
    });
  return (
    <li class="endpoint">
      <div>
        <strong>{webhook.url}</strong>
        <small>
          {webhook.events.map((event) => words.eventNames[event]).join(', ')}
          {webhook.failing_since && webhook.enabled && ` · ${words.failing(ago(webhook.failing_since))}`}
        </small>
      </div>
      <span class={`chip ${webhook.enabled ? 'succeeded' : 'failed'}`}>
        {webhook.enabled ? words.on : words.off[webhook.disabled?.code ?? 'by_owner']}
      </span>
      <div class="actions" role="group" aria-label={webhook.url}>
        <button type="button" class="toggle" disabled={doing || !webhook.enabled} onClick={() => act(() => testWebhook(webhook.id))}>
          {words.test}
        </button>
        <button
          type="button"
          class="toggle"
          disabled={doing}
          onClick={() => act(() => enableWebhook(webhook.id, !webhook.enabled))}
        >
          {webhook.enabled ? words.disable : words.enable}
        </button>
        <button
          type="button"
          class="toggle"
          aria-expanded={secret !== null}
          disabled={doing}
          onClick={() =>
            secret ? setSecret(null) : void attempt(async () => setSecret(await getWebhookSecret(webhook.id)))
          }
        >
          {words.secret}
        </button>
        <ConfirmButton
          label={strings.job.remove}
          question={words.removeQuestion}
          confirmLabel={strings.job.removeConfirm}
          onConfirm={() => act(() => deleteWebhook(webhook.id))}
        />
      </div>
      {secret && (
        <div class="secret">
          <Copyable label={words.secret} value={secret.secret} secret />
          {secret.previous_until && <p class="hint">{words.previousUntil(moment(secret.previous_until))}</p>}
          <button
            type="button"
            class="toggle"
            disabled={doing}
            onClick={() => void attempt(async () => setSecret(await rotateWebhookSecret(webhook.id)))}
          >
            {words.rotate}
          </button>
        </div>
      )}
      {problem && <ProblemAlert code={problem.code} detail={problem.detail} />}
    </li>
  );
}

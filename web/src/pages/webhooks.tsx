/** Addresses that are told when a job ends, and the log of what they were told. */

import { useState } from 'preact/hooks';
import { listWebhooks, type NewWebhook } from '../api';
import { Copyable } from '../widgets/copyable';
import { Heading } from '../widgets/heading';
import { ProblemAlert } from '../widgets/problem_alert';
import { useLoaded } from '../api/loading';
import { strings } from '../language/strings';
import { DeliveryLog } from '../webhooks/log';
import { Endpoint } from '../webhooks/endpoint';
import { NewEndpoint } from '../webhooks/new';
import '../styles/integrators.css';

const words = strings.webhooks;

export default function WebhooksPage() {
  const all = useLoaded(listWebhooks, 'webhooks');
  const [made, setMade] = useState<NewWebhook | null>(null);
  const [turn, setTurn] = useState(0);
  const changed = (): void => {
    all.reload();
    setTurn(turn + 1);
  };
  return (
    <article class="integrators">
      <Heading text={words.title} />
      <p class="lead">{words.lead}</p>
      {all.problem && <ProblemAlert code={all.problem.code} detail={all.problem.detail} />}
      {all.value && all.value.length > 0 && (
        <section class="panel" aria-labelledby="endpoints">
          <h2 id="endpoints">{words.endpoints}</h2>
          <ul class="rows">
            {all.value.map((webhook) => (
              <Endpoint key={webhook.id} webhook={webhook} onChange={changed} />
            ))}
          </ul>
        </section>
      )}
      <NewEndpoint
        onMade={(webhook) => {
          setMade(webhook);
          changed();
        }}
      />
      {made && (
        <section class="panel once" aria-label={words.secret}>
          <Copyable label={words.secretOf(made.url)} value={made.secret} />
          <p class="hint">{words.secretHint}</p>
        </section>
      )}
      <DeliveryLog turn={turn} />
    </article>
  );
}

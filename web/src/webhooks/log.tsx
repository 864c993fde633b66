/** What was told, to whom, and what came back. */

import { useEffect, useState } from 'preact/hooks';
import { type Delivery, type DeliveryDetail, getDelivery, listDeliveries, replayDelivery } from '../api';
import { ProblemAlert } from '../widgets/problem_alert';
import { ago, count, moment } from '../language/format';
import { useDoing, useLoaded } from '../api/loading';
import { jobLink } from '../route';
import { strings } from '../language/strings';

const words = strings.webhooks;
const REFRESH_MS = 3000;

/** `turn` changes when something was done that the log will show. */
export function DeliveryLog({ turn }: { turn: number }) {
  const first = useLoaded((signal) => listDeliveries(null, signal), `deliveries ${turn}`);
  const [older, setOlder] = useState<Delivery[]>([]);
  const [next, setNext] = useState<string | null | undefined>(undefined);
  const { doing, problem, attempt } = useDoing();
  const pending = first.value?.items.some((delivery) => delivery.status === 'pending') ?? false;
  useEffect(() => {
    if (!pending) return;
    const timer = setInterval(first.reload, REFRESH_MS);
    return () => clearInterval(timer);
  }, [pending]);

  const trouble = problem ?? first.problem;
  const items = first.value?.items ?? [];
  const known = new Set(items.map((delivery) => delivery.id));
  const cursor = next === undefined ? first.value?.next_cursor : next;
  const more = (): Promise<void> =>
    attempt(async () => {
      const page = await listDeliveries(cursor ?? null);
      setOlder([...older, ...page.items]);
      setNext(page.next_cursor);
    });
  return (
    <section class="panel" aria-labelledby="log">
      <h2 id="log">{words.log}</h2>
      {trouble && <ProblemAlert code={trouble.code} detail={trouble.detail} />}
      {first.value && items.length === 0 && <p class="hint">{words.logEmpty}</p>}
      <ul class="rows">
        {[...items, ...older.filter((delivery) => !known.has(delivery.id))].map((delivery) => (
          <Row key={delivery.id} delivery={delivery} onReplayed={first.reload} />
        ))}
      </ul>
      {cursor && (
        <button type="button" class="button" disabled={doing} onClick={() => void more()}>
          {strings.history.more}
        </button>
      )}
    </section>
  );
}

function Row({ delivery, onReplayed }: { delivery: Delivery; onReplayed: () => void }) {
  const [open, setOpen] = useState(false);
  const { status, last_attempt: last } = delivery;
  const chip = { delivered: 'succeeded', failed: 'failed', pending: 'running' }[status];
  const answered = last && (last.response_status ?? last.error?.code);
  return (
    <li>
      <details onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
        <summary>
          <span class={`chip ${chip}`}>{words.statuses[status]}</span>
          <span>{words.eventNames[delivery.event]}</span>
          <small>
            {delivery.url} · {ago(delivery.created_at)}
            {answered && ` · ${answered}`}
          </small>
        </summary>
        {open && <Detail key={delivery.attempts} delivery={delivery} onReplayed={onReplayed} />}
      </details>
    </li>
  );
}

function Detail({ delivery, onReplayed }: { delivery: Delivery; onReplayed: () => void }) {
  const { value, problem } = useLoaded((signal) => getDelivery(delivery.id, signal), delivery.id);
  const replay = useDoing();
  const trouble = problem ?? replay.problem;
  return (
    <div class="delivery">
      {value && <Attempts detail={value} />}
      {value && <pre tabIndex={0}>{JSON.stringify(value.data, null, 2)}</pre>}
      {trouble && <ProblemAlert code={trouble.code} detail={trouble.detail} />}
      <div class="actions">
        <button
          type="button"
          class="toggle"
          disabled={replay.doing || delivery.status === 'pending'}
          onClick={() =>
            void replay.attempt(async () => {
              await replayDelivery(delivery.id);
              onReplayed();
            })
          }
        >
          {words.replay}
        </button>
        {delivery.job_id && <a href={jobLink(delivery.job_id)}>{words.toJob}</a>}
      </div>
    </div>
  );
}

function Attempts({ detail }: { detail: DeliveryDetail }) {
  return (
    <ol>
      {detail.history.map((attempt) => (
        <li key={attempt.started_at}>
          <strong>{attempt.response_status ?? attempt.error?.code}</strong>{' '}
          <small>
            {moment(attempt.started_at)} · {words.seconds(count(Math.max(1, Math.round(attempt.seconds * 1000))))}
          </small>
          {attempt.error && <p>{attempt.error.detail}</p>}
          {attempt.response_excerpt && <pre tabIndex={0}>{attempt.response_excerpt}</pre>}
        </li>
      ))}
      {detail.next_attempt_at && <li>{words.nextAttempt(moment(detail.next_attempt_at))}</li>}
    </ol>
  );
}

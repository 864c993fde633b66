/** Keys for programs: one's own, and, for whoever may manage them, all. */

import { useId, useState } from 'preact/hooks';
import { closeSession, createKey, getOwnKey, type Key, listKeys, type NewKey, type OwnKey, revokeKey } from '../api';
import { Copyable } from '../widgets/copyable';
import { Heading } from '../widgets/heading';
import { ConfirmButton } from '../widgets/confirm';
import { ProblemAlert } from '../widgets/problem_alert';
import { ago, count, moment, size } from '../language/format';
import { useDoing, useLoaded } from '../api/loading';
import { strings } from '../language/strings';
import '../styles/integrators.css';

const words = strings.keys;
const scopes = ['read', 'submit', 'admin'] as const;
type Scope = (typeof scopes)[number];
const terms = { open: null, month: 30, year: 365 } as const;
type Term = keyof typeof terms;

/** The key that stands for whoever sits at the machine of the service, where no key is needed. */
const LOCAL = 'local';

export default function KeysPage() {
  const own = useLoaded(getOwnKey, 'own key');
  const mayManage = own.value?.scopes.includes('admin') ?? false;
  return (
    <article class="integrators">
      <Heading text={words.title} />
      <p class="lead">{words.lead}</p>
      {own.problem && <ProblemAlert code={own.problem.code} detail={own.problem.detail} />}
      {own.value && <Own own={own.value} />}
      {own.value && (mayManage ? <All own={own.value.id} /> : <p class="hint">{words.notManager}</p>)}
    </article>
  );
}

function Own({ own }: { own: OwnKey }) {
  const { attempt } = useDoing();
  const leave = (): Promise<void> =>
    attempt(async () => {
      await closeSession();
      location.reload();
    });
  return (
    <section class="panel" aria-labelledby="own">
      <h2 id="own">{own.id === LOCAL ? words.here : own.name}</h2>
      <dl class="facts">
        <Fact name={words.scopes} value={own.scopes.map((scope) => words.scopeNames[scope as Scope] ?? scope).join(', ')} />
        <Fact name={words.underWay} value={of(count(own.jobs_under_way), own.jobs_at_once && count(own.jobs_at_once))} />
        <Fact name={words.stored} value={of(size(own.stored_bytes), own.stored_mb && size(own.stored_mb * 1e6))} />
        {own.requests_per_minute !== null && <Fact name={words.rate} value={count(own.requests_per_minute)} />}
        {own.expires_at && <Fact name={words.expires} value={moment(own.expires_at)} />}
      </dl>
      {own.signing_secret && (
        <>
          <Copyable label={words.signing} value={own.signing_secret} secret />
          <p class="hint">{words.signingHint}</p>
        </>
      )}
      {own.id !== LOCAL && (
        <button type="button" class="button" onClick={() => void leave()}>
          {words.leave}
        </button>
      )}
    </section>
  );
}

const of = (used: string, limit: string | 0 | null): string => (limit ? words.of(used, limit) : used);

function Fact({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{value}</dd>
    </div>
  );
}

function All({ own }: { own: string }) {
  const all = useLoaded(listKeys, 'keys');
  const { doing, problem, attempt } = useDoing();
  const [made, setMade] = useState<NewKey | null>(null);
  const revoke = (key: Key): Promise<void> =>
    attempt(async () => {
      await revokeKey(key.id);
      if (made?.id === key.id) setMade(null);
      all.reload();
    });
  return (
    <>
      <NewKeyForm
        doing={doing}
        onCreate={(name, chosen, days) =>
          attempt(async () => {
            setMade(await createKey(name, chosen, days));
            all.reload();
          })
        }
      />
      {problem && <ProblemAlert code={problem.code} detail={problem.detail} />}
      {made && (
        <section class="panel once" aria-label={words.made(made.name)}>
          <h2>{words.made(made.name)}</h2>
          <Copyable label={words.token} value={made.token} />
          <p class="hint">{words.once}</p>
          <pre tabIndex={0}>{`curl -H 'Authorization: Bearer ${made.token}' ${location.origin}/v1/jobs`}</pre>
        </section>
      )}
      {all.problem && <ProblemAlert code={all.problem.code} detail={all.problem.detail} />}
      {all.value && all.value.length > 0 && (
        <section class="panel" aria-labelledby="all">
          <h2 id="all">{words.all}</h2>
          <ul class="rows">
            {all.value.map((key) => (
              <li key={key.id} class={key.revoked_at ? 'past' : ''}>
                <div>
                  <strong>{key.name}</strong> <code>{key.hint}…</code>
                  <small>
                    {key.scopes.map((scope) => words.scopeNames[scope as Scope] ?? scope).join(', ')}
                    {' · '}
                    {key.last_used_at ? words.used(ago(key.last_used_at)) : words.unused}
                    {key.expires_at && ` · ${words.expires} ${moment(key.expires_at)}`}
                  </small>
                </div>
                {key.revoked_at ? (
                  <span class="chip">{words.revoked}</span>
                ) : (
                  key.id !== own && (
                    <ConfirmButton
                      label={words.revoke}
                      about={key.name}
                      question={words.revokeQuestion(key.name)}
                      confirmLabel={words.revokeConfirm}
                      onConfirm={() => void revoke(key)}
                    />
                  )
                )}
              </li>
            ))}
          </ul>
        </section>
      )}
    </>
  );
}

interface FormProps {
  doing: boolean;
  onCreate: (name: string, chosen: Scope[], days: number | null) => Promise<void>;
}

function NewKeyForm({ doing, onCreate }: FormProps) {
  const name = useId();
  const term = useId();
  const [called, setCalled] = useState('');
  const [chosen, setChosen] = useState<readonly Scope[]>(['read', 'submit']);
  const [until, setUntil] = useState<Term>('open');
  return (
    <form
      class="panel"
      aria-label={words.newTitle}
      onSubmit={(event) => {
        event.preventDefault();
        void onCreate(called.trim(), [...chosen], terms[until]).then(() => setCalled(''));
      }}
    >
      <h2>{words.newTitle}</h2>
      <div class="columns">
        <div class="field">
          <label for={name}>{words.name}</label>
          <input
            id={name}
            required
            maxLength={100}
            placeholder={words.namePlaceholder}
            value={called}
            onInput={({ currentTarget }) => setCalled(currentTarget.value)}
          />
        </div>
        <div class="field">
          <label for={term}>{words.term}</label>
          <select id={term} value={until} onChange={({ currentTarget }) => setUntil(currentTarget.value as Term)}>
            {(Object.keys(terms) as Term[]).map((one) => (
              <option key={one} value={one}>
                {words.terms[one]}
              </option>
            ))}
          </select>
        </div>
      </div>
      <fieldset class="field">
        <legend>{words.scopes}</legend>
        {scopes.map((scope) => (
          <label key={scope} class="check wide">
            <input
              type="checkbox"
              checked={chosen.includes(scope)}
              onChange={({ currentTarget }) =>
                setChosen(scopes.filter((one) => (one === scope ? currentTarget.checked : chosen.includes(one))))
              }
            />
            <span>
              {words.scopeNames[scope]} <small>{words.scopeHints[scope]}</small>
            </span>
          </label>
        ))}
      </fieldset>
      <button type="submit" class="button primary" disabled={doing || !called.trim() || chosen.length === 0}>
        {words.create}
      </button>
    </form>
  );
}

/** Links that open a result to others, for as long as one likes. */

import { useId, useState } from 'preact/hooks';
import { createLink, type Job, listLinks, type PublicLink, revokeLink } from '../api';
import { Copyable } from '../widgets/copyable';
import { ProblemAlert } from '../widgets/problem_alert';
import { moment } from '../language/format';
import type { Kind } from '../kind/kind';
import { useKind } from '../kind/kinds';
import { useDoing, useLoaded } from '../api/loading';
import { strings } from '../language/strings';
import { isLoopback } from './host';
import QrCode from './qr';
import '../styles/share.css';

const words = strings.share;
const terms = { day: 24, week: 7 * 24, month: 30 * 24, open: null } as const;
type Term = keyof typeof terms;

export default function SharePanel({ job }: { job: Job }) {
  const kind = useKind(job.kind);
  const links = useLoaded((signal) => listLinks(job.id, signal), `links ${job.id}`);
  const { doing, problem, attempt } = useDoing();
  const [term, setTerm] = useState<Term>('week');
  const [everything, setEverything] = useState(false);
  const [made, setMade] = useState<Record<string, string>>({}); // the pages of links: the service tells each once
  const id = useId();

  const create = (): Promise<void> =>
    attempt(async () => {
      const link = await createLink(job.id, terms[term], everything ? null : openedIn(job, kind));
      if (link.page) setMade((pages) => ({ ...pages, [link.id]: link.page as string }));
      links.reload();
    });
  const revoke = (link: PublicLink): Promise<void> =>
    attempt(async () => {
      await revokeLink(link.id);
      links.reload();
    });

  return (
    <section class="panel share" aria-label={words.title}>
      <p class="hint">{words.hint}</p>
      {isLoopback(location.hostname) && <p class="hint">{words.here(location.host)}</p>}
      <div class="choose">
        <label class="inline" for={id}>
          <span>{words.term}</span>
          <select id={id} value={term} onChange={({ currentTarget }) => setTerm(currentTarget.value as Term)}>
            {(Object.keys(terms) as Term[]).map((one) => (
              <option key={one} value={one}>
                {words.terms[one]}
              </option>
            ))}
          </select>
        </label>
        <label class="check">
          <input type="checkbox" checked={everything} onChange={() => setEverything(!everything)} />
          <span>{words.everything}</span>
        </label>
        <button type="button" class="button primary" disabled={doing} onClick={() => void create()}>
          {words.create}
        </button>
      </div>
      {problem && <ProblemAlert code={problem.code} detail={problem.detail} />}
      {links.problem && <ProblemAlert code={links.problem.code} detail={links.problem.detail} />}
      <ul>
        {links.value?.map((link) => (
          <li key={link.id}>
            {made[link.id] ? (
              <Copyable
                label={links.value?.length === 1 ? words.link : words.linkOf(moment(link.created_at))}
                value={new URL(made[link.id] as string, location.href).href}
              />
            ) : (
              <span>{words.earlier(moment(link.created_at), link.hint)}</span>
            )}
            {made[link.id] && !isLoopback(location.hostname) && (
              <QrCode text={new URL(made[link.id] as string, location.href).href} />
            )}
            <small>
              {link.expires_at ? words.until(moment(link.expires_at)) : words.untilRevoked}
              {' · '}
              {link.artifacts ? words.videoOnly : words.allFiles}
            </small>
            <button type="button" class="button quiet" disabled={doing} onClick={() => void revoke(link)}>
              {words.revoke}
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}

/** What a link opens unless it is to open everything. */
const openedIn = (job: Job, { shared }: Kind): string[] =>
  Object.keys(job.artifacts).filter((name) => shared.opened.test(name));

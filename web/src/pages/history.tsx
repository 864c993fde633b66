/** Everything that was made, newest first; all of it, what came to one end, or what is found by words. */

import type { ComponentChildren } from 'preact';
import type { Status } from '../api';
import { Heading } from '../widgets/heading';
import { SearchField } from '../widgets/search';
import { ProblemAlert } from '../widgets/problem_alert';
import { Work } from '../works/work';
import { useWorks } from '../works/works';
import { historyLink, MAX_SEARCH_CHARACTERS, replaceAddress, statuses, studioLink } from '../route';
import { strings } from '../language/strings';
import '../styles/history.css';

/** Works of a page of the list. */
const PAGE_SIZE = 24;
const words = strings.history;

interface Wanted {
  status: Status | null;
  words: string;
}

export function HistoryPage(wanted: Wanted) {
  return (
    <article class="history">
      <Heading text={words.title} />
      <div class="history-tools">
        <SearchField
          label={words.search}
          hint={words.searchHint}
          longest={MAX_SEARCH_CHARACTERS}
          value={wanted.words}
          onSearch={(query) => replaceAddress(historyLink(wanted.status, query))}
        />
        <nav class="filters" aria-label={words.filter}>
          {[null, ...statuses].map((one) => (
            <a
              key={one}
              href={historyLink(one, wanted.words)}
              aria-current={one === wanted.status ? 'page' : undefined}
            >
              {one ? strings.status[one] : words.all}
            </a>
          ))}
        </nav>
      </div>
      <Works {...wanted} />
    </article>
  );
}

function Works(wanted: Wanted) {
  const { jobs, versions, stale, problem, retry, more } = useWorks(PAGE_SIZE, wanted);
  const settled = jobs !== null && !stale && !problem;
  return (
    <>
      <p class="visually-hidden" role="status">
        {settled && wanted.words && (jobs.length ? words.found(jobs.length, more !== null) : words.nothingFound(wanted.words))}
      </p>
      {settled && jobs.length === 0 && <Nothing {...wanted} />}
      {jobs && jobs.length > 0 && (
        <ul class="works" aria-busy={stale}>
          {jobs.map((job) => (
            <Work key={job.tree} job={job} versions={versions[job.tree] ?? 1} />
          ))}
        </ul>
      )}
      {!jobs && !problem && <div class="works waiting" aria-busy="true" />}
      {problem && (
        <ProblemAlert code={problem.code} detail={problem.detail}>
          <button type="button" class="button" onClick={retry}>
            {strings.retry}
          </button>
        </ProblemAlert>
      )}
      {more && (
        <button type="button" class="button" onClick={() => void more()}>
          {words.more}
        </button>
      )}
    </>
  );
}

/** Why there is nothing, and what one can do then. */
function Nothing({ status, words: query }: Wanted) {
  if (query) {
    return (
      <Empty title={words.nothingFound(query)} hint={words.nothingFoundHint}>
        <a class="button" href={historyLink(status)}>
          {words.clear}
        </a>
      </Empty>
    );
  }
  if (status) {
    return (
      <Empty title={words.none}>
        <a class="button" href={historyLink(null)}>
          {words.showAll}
        </a>
      </Empty>
    );
  }
  return (
    <Empty title={words.empty} hint={words.emptyHint}>
      <a class="button primary" href={studioLink}>
        {words.begin}
      </a>
    </Empty>
  );
}

function Empty({ title, hint, children }: { title: string; hint?: string; children: ComponentChildren }) {
  return (
    <section class="empty-state">
      <h2>{title}</h2>
      {hint && <p class="hint">{hint}</p>}
      {children}
    </section>
  );
}

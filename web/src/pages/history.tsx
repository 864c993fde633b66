/** Everything that was made, newest first; all of it or what came to one end. */

import type { Status } from '../api';
import { Entries } from '../components/entry';
import { Heading } from '../components/heading';
import { Trouble } from '../components/trouble';
import { useJobs } from '../jobs';
import { historyLink, statuses } from '../route';
import { strings } from '../strings';

const PAGE = 24;
const words = strings.history;

export function HistoryPage({ status }: { status: Status | null }) {
  return (
    <article class="history">
      <Heading text={words.title} />
      <nav class="filters" aria-label={words.filter}>
        {[null, ...statuses].map((one) => (
          <a key={one} href={historyLink(one)} aria-current={one === status ? 'page' : undefined}>
            {one ? strings.status[one] : words.all}
          </a>
        ))}
      </nav>
      <Jobs key={status} status={status} />
    </article>
  );
}

function Jobs({ status }: { status: Status | null }) {
  const { jobs, problem, retry, more } = useJobs(PAGE, status);
  return (
    <>
      {jobs?.length === 0 && <p class="hint">{status ? words.none : strings.recent.empty}</p>}
      {jobs ? <Entries jobs={jobs} /> : !problem && <div aria-busy="true" />}
      {problem && (
        <Trouble code={problem.code} detail={problem.detail}>
          <button type="button" class="button" onClick={retry}>
            {strings.retry}
          </button>
        </Trouble>
      )}
      {more && (
        <button type="button" class="button" onClick={() => void more()}>
          {words.more}
        </button>
      )}
    </>
  );
}

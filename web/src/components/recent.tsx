/** The latest jobs, each with its poster. */

import { useJobs } from '../jobs';
import { historyLink } from '../route';
import { strings } from '../strings';
import { Entries } from './entry';

const LATEST = 6;

export function Recent() {
  const { jobs, more } = useJobs(LATEST, null);
  if (!jobs) return null;
  return (
    <section class="recent" aria-labelledby="recent-title">
      <h2 id="recent-title">{strings.recent.title}</h2>
      {jobs.length === 0 ? <p class="hint">{strings.recent.empty}</p> : <Entries jobs={jobs} />}
      {more && (
        <a class="button" href={historyLink(null)}>
          {strings.recent.all}
        </a>
      )}
    </section>
  );
}

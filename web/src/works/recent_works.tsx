/** The latest works, each with its poster. */

import { allWorks, useWorks } from './works';
import { historyLink } from '../route';
import { strings } from '../language/strings';
import { Entry } from './entry';

const MAX_RECENT = 6;

export function RecentWorks() {
  const { jobs, more } = useWorks(MAX_RECENT, allWorks);
  if (!jobs) return null;
  return (
    <section class="recent" aria-labelledby="recent-title">
      <h2 id="recent-title">{strings.recent.title}</h2>
      {jobs.length === 0 ? (
        <p class="hint">{strings.recent.empty}</p>
      ) : (
        <ul class="entries">
          {jobs.map((job) => (
            <li key={job.tree}>
              <Entry job={job} />
            </li>
          ))}
        </ul>
      )}
      {more && (
        <a class="button" href={historyLink(null)}>
          {strings.recent.all}
        </a>
      )}
    </section>
  );
}

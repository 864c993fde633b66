/** The latest jobs, each with its poster. */

import { useEffect, useState } from 'preact/hooks';
import { type Job, listJobs } from '../api';
import { ago, percent } from '../format';
import { useLoaded } from '../loading';
import { performanceName, portraitName, portraitUrl } from '../names';
import { jobLink } from '../route';
import { strings } from '../strings';
import { Picture } from './picture';

const REFRESH_MS = 4000;

export function Recent() {
  const first = useLoaded((signal) => listJobs(null, signal), 'recent');
  const [older, setOlder] = useState<Job[]>([]);
  const [next, setNext] = useState<string | null | undefined>(undefined);

  const busy = first.value?.items.some((job) => job.status === 'queued' || job.status === 'running') ?? false;
  useEffect(() => {
    if (!busy) return;
    const timer = setInterval(first.reload, REFRESH_MS);
    return () => clearInterval(timer);
  }, [busy]);

  if (!first.value) return null;
  const known = new Set(first.value.items.map((job) => job.id));
  const jobs = [...first.value.items, ...older.filter((job) => !known.has(job.id))];
  const cursor = next === undefined ? first.value.next_cursor : next;
  const more = async (): Promise<void> => {
    const page = await listJobs(cursor);
    setOlder([...older, ...page.items]);
    setNext(page.next_cursor);
  };

  return (
    <section class="recent" aria-labelledby="recent-title">
      <h2 id="recent-title">{strings.recent.title}</h2>
      {jobs.length === 0 ? (
        <p class="hint">{strings.recent.empty}</p>
      ) : (
        <ul>
          {jobs.map((job) => (
            <li key={job.id}>
              <Entry job={job} />
            </li>
          ))}
        </ul>
      )}
      {cursor && (
        <button type="button" class="button" onClick={() => void more()}>
          {strings.recent.more}
        </button>
      )}
    </section>
  );
}

function Entry({ job }: { job: Job }) {
  const picture = job.artifacts['poster.jpg'] ?? job.artifacts['preview.jpg'];
  const performance = performanceName(job);
  const status =
    job.status === 'running' ? percent(job.progress.fraction) : strings.status[job.status];
  return (
    <a class="entry" href={jobLink(job.id)}>
      <span class="poster">
        <Picture url={picture?.url ?? portraitUrl(job)} alt="" lazy />
      </span>
      <span class="name">{portraitName(job)}</span>
      <span class="details">
        {performance && <span>{performance}</span>}
        <span class="state">
          {job.status !== 'succeeded' && <span class={`chip ${job.status}`}>{status}</span>}
          <time dateTime={job.created_at}>{ago(job.created_at)}</time>
        </span>
      </span>
    </a>
  );
}

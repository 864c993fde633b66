/** A job among others: a small picture of it, its name, and where it stands. */

import type { Job } from '../api';
import { ago, percent } from '../language/format';
import { useKind } from '../kind/kinds';
import { pictureUrl, workName } from './names';
import { jobLink } from '../route';
import { strings } from '../language/strings';
import { Picture } from '../widgets/picture';

export function Entry({ job }: { job: Job }) {
  const kind = useKind(job.kind);
  return (
    <a class="entry" href={jobLink(job.id)}>
      <Poster job={job} />
      <span class="name">{workName(job, kind)}</span>
      <Details job={job} />
    </a>
  );
}

export function Poster({ job }: { job: Job }) {
  const kind = useKind(job.kind);
  // Jobs of earlier versions have no thumbnail.
  const picture = ['thumbnail.jpg', 'poster.jpg', 'preview.jpg'].map((name) => job.artifacts[name]).find(Boolean);
  return (
    <span class={`poster ${job.kind}`}>
      <Picture url={picture?.url ?? pictureUrl(job, kind)} alt="" lazy />
    </span>
  );
}

export function Details({ id, job }: { id?: string; job: Job }) {
  const performance = useKind(job.kind).performance(job);
  return (
    <span class="details" id={id}>
      {performance && <span>{performance}</span>}
      <State job={job} />
    </span>
  );
}

/** How a job ended, or how far it is, where that is to be said; and when it was submitted. */
export function State({ job }: { job: Job }) {
  const status = job.status === 'running' ? percent(job.progress.fraction ?? 0) : strings.status[job.status];
  return (
    <span class="state">
      {job.status !== 'succeeded' && <span class={`chip ${job.status}`}>{status}</span>}
      <time dateTime={job.created_at}>{ago(job.created_at)}</time>
    </span>
  );
}

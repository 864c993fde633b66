/** A job among others: a small picture of it, its name, and where it stands. */

import type { Job } from '../api';
import { ago, percent } from '../format';
import { performanceName, pictureName, pictureUrl } from '../names';
import { jobLink } from '../route';
import { strings } from '../strings';
import { Picture } from './picture';

export function Entry({ job }: { job: Job }) {
  // Jobs of earlier versions have no thumbnail.
  const picture = ['thumbnail.jpg', 'poster.jpg', 'preview.jpg'].map((name) => job.artifacts[name]).find(Boolean);
  const performance = performanceName(job);
  const status = job.status === 'running' ? percent(job.progress.fraction ?? 0) : strings.status[job.status];
  return (
    <a class="entry" href={jobLink(job.id)}>
      <span class="poster">
        <Picture url={picture?.url ?? pictureUrl(job)} alt="" lazy />
      </span>
      <span class="name">{pictureName(job)}</span>
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

export function Entries({ jobs }: { jobs: Job[] }) {
  return (
    <ul class="entries">
      {jobs.map((job) => (
        <li key={job.id}>
          <Entry job={job} />
        </li>
      ))}
    </ul>
  );
}

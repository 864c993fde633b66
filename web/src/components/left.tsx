/** What a finished run has left: its files, links to them, and what it has to say. */

import { useState } from 'preact/hooks';
import { archiveUrl, type Job, type Report } from '../api';
import { duration, size } from '../format';
import { strings } from '../strings';
import { later } from './later';

const SharePanel = later(() => import('../share/panel'));
const CodePanel = later(() => import('../share/code'));
const words = strings.job;

/** Everything that the run left, each to be saved by itself. */
export function Files({ job, open }: { job: Job; open: boolean }) {
  return (
    <details class="files" open={open}>
      <summary class="button">{words.files}</summary>
      <ul>
        <li>
          <a href={archiveUrl(job.id)} download>
            {words.archive}
          </a>
        </li>
        {Object.entries(job.artifacts).map(([name, artifact]) => (
          <li key={name}>
            <a href={artifact.url} download={name}>
              {name}
            </a>{' '}
            <small>{size(artifact.size)}</small>
          </li>
        ))}
      </ul>
    </details>
  );
}

/** Links to the result, made where somebody looks for them. */
export function Sharing({ job }: { job: Job }) {
  const [open, setOpen] = useState(false);
  return (
    <details class="files" open={open} onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary class="button">{strings.share.title}</summary>
      {open && <SharePanel job={job} />}
    </details>
  );
}

/** The request that made the result, for who wants to make more of them. */
export function InCode({ job }: { job: Job }) {
  const [open, setOpen] = useState(false);
  return (
    <details class="files" open={open} onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary class="button">{words.use}</summary>
      {open && <CodePanel job={job} />}
    </details>
  );
}

export function Warnings({ report }: { report: Report | null }) {
  if (!report?.warnings.length) return null;
  return (
    <section class="warnings" aria-label={words.warnings}>
      <h2>{words.warnings}</h2>
      <ul>
        {report.warnings.map((warning) => (
          <li key={warning.code + warning.message}>{warning.message}</li>
        ))}
      </ul>
    </section>
  );
}

export function Took({ job }: { job: Job }) {
  if (!job.started_at || !job.finished_at) return null;
  return (
    <p class="took">{words.took(duration((Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000))}</p>
  );
}

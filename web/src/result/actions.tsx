/** What a finished run has left: its files, links to them, and what it has to say. */

import type { ComponentChildren } from 'preact';
import { useId, useState } from 'preact/hooks';
import { archiveUrl, type Job, type Report } from '../api';
import { duration, size } from '../language/format';
import { strings } from '../language/strings';
import { later } from '../widgets/lazy';

const SharePanel = later(() => import('../share/panel'));
const CodePanel = later(() => import('../share/code'));
const words = strings.job;

type Panel = 'files' | 'share' | 'code';
const panels = { files: words.files, share: strings.share.title, code: words.use };

interface Props {
  job: Job;
  /** The list of files is open from the first: there is nothing else to see. */
  filesOpen: boolean;
  /** What is downloaded most. */
  children: ComponentChildren;
}

/** What can be done with a result, in one row that stays as it is; what that takes opens below it. */
export function ResultActions({ job, filesOpen, children }: Props) {
  const [open, setOpen] = useState<readonly Panel[]>(filesOpen ? ['files'] : []);
  const id = useId();
  const toggle = (panel: Panel): void =>
    setOpen(open.includes(panel) ? open.filter((one) => one !== panel) : [...open, panel]);
  return (
    <div class="result-actions">
      <div class="toolbar">
        <div class="actions">{children}</div>
        <div class="actions">
          {(Object.keys(panels) as Panel[]).map((panel) => (
            <button
              key={panel}
              type="button"
              class="button"
              aria-expanded={open.includes(panel)}
              aria-controls={`${id}-${panel}`}
              onClick={() => toggle(panel)}
            >
              {panels[panel]}
            </button>
          ))}
        </div>
      </div>
      {(Object.keys(panels) as Panel[]).map((panel) => (
        <div key={panel} id={`${id}-${panel}`} hidden={!open.includes(panel)}>
          {!open.includes(panel) ? null : panel === 'files' ? (
            <Files job={job} />
          ) : panel === 'share' ? (
            <SharePanel job={job} />
          ) : (
            <CodePanel job={job} />
          )}
        </div>
      ))}
    </div>
  );
}

/** Everything that the run left, each to be saved by itself. */
function Files({ job }: { job: Job }) {
  return (
    <section class="panel files" aria-label={words.files}>
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
    </section>
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

export function ElapsedTime({ job }: { job: Job }) {
  if (!job.started_at || !job.finished_at) return null;
  return (
    <p class="elapsed-time">{words.took(duration((Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000))}</p>
  );
}

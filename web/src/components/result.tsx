/** A finished job: its video beside the performance, downloads, and what the run has to say. */

import { type Artifact, getReport, type Job } from '../api';
import { duration, size } from '../format';
import { useLoaded } from '../loading';
import { performanceUrl } from '../names';
import { strings } from '../strings';
import { Player } from './player';

const words = strings.job;

/** The animation, where it has a format that browsers show: a video or a moving picture, not a zip of frames. */
function animation(job: Job): [string, Artifact] | null {
  const shown = ([name, artifact]: [string, Artifact]): boolean =>
    name.startsWith('animation.') && /^(video|image)\//.test(artifact.content_type);
  return Object.entries(job.artifacts).find(shown) ?? null;
}

export function Result({ job }: { job: Job }) {
  const report = useLoaded((signal) => getReport(job, signal), job.id);
  const found = animation(job);
  const warnings = report.value?.warnings ?? [];

  return (
    <div class="result">
      {found ? <Animation job={job} artifact={found[1]} /> : <p>{words.otherKind}</p>}
      <div class="actions">
        {found && (
          <a class="button primary" href={found[1].url} download={found[0]}>
            {words.download} <small>{size(found[1].size)}</small>
          </a>
        )}
        <Files job={job} open={!found} />
      </div>
      {warnings.length > 0 && (
        <section class="warnings" aria-label={words.warnings}>
          <h2>{words.warnings}</h2>
          <ul>
            {warnings.map((warning) => (
              <li key={warning.code + warning.message}>{warning.message}</li>
            ))}
          </ul>
        </section>
      )}
      {job.started_at && job.finished_at && (
        <p class="took">
          {words.took(duration((Date.parse(job.finished_at) - Date.parse(job.started_at)) / 1000))}
        </p>
      )}
    </div>
  );
}

function Animation({ job, artifact }: { job: Job; artifact: Artifact }) {
  if (artifact.content_type.startsWith('image/')) {
    return (
      <figure class="still">
        <img src={artifact.url} alt={words.resultAlt} />
      </figure>
    );
  }
  return (
    <Player
      result={artifact.url}
      poster={job.artifacts['poster.jpg']?.url}
      driver={performanceUrl(job)}
      start={job.options.trim?.[0] ?? 0}
      hasSound={job.options.sound === true}
    />
  );
}

/** Everything that the run left, each to be saved by itself. */
function Files({ job, open }: { job: Job; open: boolean }) {
  return (
    <details class="files" open={open}>
      <summary class="button">{words.files}</summary>
      <ul>
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

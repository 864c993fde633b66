/** One job: on its way, done, failed or canceled. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { cancelJob, deleteJob, type Job, type Problem } from '../api';
import { Picture } from '../components/picture';
import { Removal } from '../components/removal';
import { Result } from '../components/result';
import { Stages } from '../components/stages';
import { Trouble } from '../components/trouble';
import { finished, useJob } from '../events';
import { asProblem } from '../loading';
import { performanceName, portraitName, portraitUrl } from '../names';
import { studioLink } from '../route';
import { strings } from '../strings';

const words = strings.job;

export function JobPage({ id }: { id: string }) {
  const { job, problem, stages, interrupted } = useJob(id);
  const [failure, setFailure] = useState<Problem | null>(null);

  if (problem?.status === 404) {
    return (
      <article class="job">
        <Heading text={words.notFound} />
        <p>{words.notFoundDetail}</p>
        <Back />
      </article>
    );
  }
  if (problem) return <Trouble code={problem.code} detail={problem.detail} />;
  if (!job) return interrupted ? <Trouble code="unreachable" detail="" /> : <div class="job" aria-busy="true" />;

  const remove = async (): Promise<void> => {
    try {
      await deleteJob(id);
      location.hash = studioLink;
    } catch (error) {
      setFailure(asProblem(error));
    }
  };

  const performance = performanceName(job);
  return (
    <article class="job" aria-busy={!finished(job)}>
      <Heading text={words.title(portraitName(job))} />
      <p class="status">
        <span class={`chip ${job.status}`}>{strings.status[job.status]}</span>
        {performance && <span>{words.performance(performance)}</span>}
      </p>
      <p class="unseen" role="status">
        {finished(job) ? strings.status[job.status] : ''}
      </p>
      {interrupted && !finished(job) && (
        <p class="interrupted" role="status">
          {words.interrupted}
        </p>
      )}
      <Body job={job} stages={stages} onProblem={setFailure} />
      {failure && <Trouble code={failure.code} detail={failure.detail} />}
      {finished(job) && (
        <footer class="actions">
          <Back />
          <Removal onRemove={() => void remove()} />
        </footer>
      )}
    </article>
  );
}

interface BodyProps {
  job: Job;
  stages: string[];
  onProblem: (problem: Problem) => void;
}

function Body({ job, stages, onProblem }: BodyProps) {
  switch (job.status) {
    case 'succeeded':
      return <Result job={job} />;
    case 'failed':
      return (
        <div class="ended">
          <Picture url={portraitUrl(job)} alt={words.sentAlt} />
          <Trouble code={job.error?.code ?? 'internal_error'} detail={job.error?.detail ?? ''} />
        </div>
      );
    case 'canceled':
      return (
        <div class="ended">
          <Picture url={portraitUrl(job)} alt={words.sentAlt} />
          <p>{words.canceledDetail}</p>
        </div>
      );
    default:
      return <Running job={job} stages={stages} onProblem={onProblem} />;
  }
}

function Running({ job, stages, onProblem }: BodyProps) {
  const [canceling, setCanceling] = useState(false);
  const preview = job.artifacts['preview.jpg'];
  const cancel = (): void => {
    setCanceling(true);
    cancelJob(job.id).catch((error: unknown) => {
      setCanceling(false);
      onProblem(asProblem(error));
    });
  };
  return (
    <div class="underway">
      <figure class="impression">
        {preview ? (
          <Picture key="preview" class="fresh" url={preview.url} alt={words.previewAlt} />
        ) : (
          <Picture key="portrait" class="awaiting" url={portraitUrl(job)} alt="" />
        )}
        <figcaption>{preview ? words.preview : words.previewSoon}</figcaption>
      </figure>
      <div>
        <Stages job={job} stages={stages} />
        <button type="button" class="button" disabled={canceling} onClick={cancel}>
          {canceling ? words.canceling : words.cancel}
        </button>
      </div>
    </div>
  );
}

function Back() {
  return (
    <a class="button" href={studioLink}>
      {words.back}
    </a>
  );
}

/** The page's heading takes the focus, so that a change of page is heard as well as seen. */
function Heading({ text }: { text: string }) {
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => {
    document.title = `${text} · ${strings.name}`;
    heading.current?.focus();
  }, [text]);
  return (
    <h1 ref={heading} tabIndex={-1}>
      {text}
    </h1>
  );
}

/** One job: on its way, done, failed or canceled. */

import { useEffect, useState } from 'preact/hooks';
import { cancelJob, deleteJob, type Job, type Problem } from '../api';
import { Heading } from '../widgets/heading';
import { part } from '../widgets/lazy';
import { Picture } from '../widgets/picture';
import { useKind, useKinds } from '../kind/kinds';
import type { Proposal, ResultProps } from '../kind/kind';
import { useJobDetails } from '../result/job_details';
import { Revise, Versions } from '../result/revise';
import { Rename } from '../widgets/rename';
import { Stages } from '../result/stages';
import { ConfirmButton } from '../widgets/confirm';
import { LoadingProblem, ProblemAlert } from '../widgets/problem_alert';
import { finished, useJob } from '../api/events';
import { asProblem } from '../api/loading';
import { wantsPicture } from '../result/next_step';
import { MAX_TITLE_CHARACTERS, pictureUrl, workName } from '../works/names';
import { studioLink } from '../route';
import { strings } from '../language/strings';
import { useTitle } from '../works/titles';

const words = strings.job;

export function JobPage({ id }: { id: string }) {
  const { job: newest, problem, stages, interrupted } = useJob(id);
  const kinds = useKinds();
  const details = useJobDetails(newest, kinds.of);
  const [failure, setFailure] = useState<Problem | null>(null);
  const [proposal, setProposal] = useState<Proposal | null>(null);

  if (problem?.status === 404) {
    return (
      <article class="lost">
        <Heading text={words.notFound} />
        <p>{words.notFoundDetail}</p>
        <a class="button primary" href={studioLink}>
          {strings.lost.home}
        </a>
      </article>
    );
  }
  if (problem) return <ProblemAlert code={problem.code} detail={problem.detail} />;
  if (!details) return interrupted ? <ProblemAlert code="unreachable" detail="" /> : <div class="job" aria-busy="true" />;

  const { job, versions, report } = details;
  const kind = kinds.of(job.kind);
  const remove = async (): Promise<void> => {
    try {
      await deleteJob(id);
      location.hash = kind.link;
    } catch (error) {
      setFailure(asProblem(error));
    }
  };

  const performance = kind.performance(job);
  return (
    <article class="job" aria-busy={!finished(job)}>
      <Title key={job.tree} job={job} />
      <p class="status">
        <span class={`chip ${job.status}`}>{strings.status[job.status]}</span>
        {performance && <span>{kind.performed(performance)}</span>}
      </p>
      <Versions job={job} all={versions} />
      <p class="visually-hidden" role="status">
        {finished(job) ? strings.status[job.status] : ''}
      </p>
      {interrupted && !finished(job) && (
        <p class="interrupted" role="status">
          {words.interrupted}
        </p>
      )}
      <Body job={job} report={report} stages={stages} onProblem={setFailure} onPropose={setProposal} />
      <LoadingProblem of={details} />
      {finished(job) && kind.loadCorrections && (
        <Revise
          key={job.id}
          load={kind.loadCorrections}
          job={job}
          report={report}
          proposal={proposal}
          onProposalTaken={() => setProposal(null)}
          onProblem={setFailure}
        />
      )}
      {failure && <ProblemAlert code={failure.code} detail={failure.detail} />}
      {finished(job) && (
        <footer class="actions">
          <Back to={kind.link} />
          <ConfirmButton
            label={words.remove}
            question={words.removeQuestion}
            confirmLabel={words.removeConfirm}
            onConfirm={() => void remove()}
          />
        </footer>
      )}
    </article>
  );
}

function Title({ job }: { job: Job }) {
  const [titled, rename] = useTitle(job);
  const name = workName(titled, useKind(job.kind));
  const [arrived, setArrived] = useState(false);
  useEffect(() => setArrived(true), []);
  return (
    <Rename name={name} label={strings.history.titleOf(name)} longest={MAX_TITLE_CHARACTERS} onRename={rename}>
      <Heading text={words.title(name)} still={arrived} />
    </Rename>
  );
}

interface BodyProps {
  job: Job;
  stages: string[];
  onProblem: (problem: Problem) => void;
}

function Body({ job, report, stages, onProblem, onPropose }: BodyProps & Pick<ResultProps, 'report' | 'onPropose'>) {
  const kind = useKind(job.kind);
  switch (job.status) {
    case 'succeeded': {
      const Result = part(kind.loadResult);
      return <Result job={job} report={report} onPropose={onPropose} />;
    }
    case 'failed':
      return (
        <div class="job-ended">
          <Picture url={pictureUrl(job, kind)} alt={words.sentAlt} />
          <ProblemAlert code={job.error?.code ?? 'internal_error'} detail={job.error?.detail ?? ''}>
            {wantsPicture(job) && (
              <a class="button primary" href={kind.link}>
                {words.anotherPicture}
              </a>
            )}
          </ProblemAlert>
        </div>
      );
    case 'canceled':
      return (
        <div class="job-ended">
          <Picture url={pictureUrl(job, kind)} alt={words.sentAlt} />
          <p>{words.canceledDetail}</p>
        </div>
      );
    default:
      return <Running job={job} stages={stages} onProblem={onProblem} />;
  }
}

function Running({ job, stages, onProblem }: BodyProps) {
  const kind = useKind(job.kind);
  const Progress = kind.loadProgress && part(kind.loadProgress);
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
    <>
      <div class="job-running">
        <figure class="job-preview">
          {preview ? (
            <Picture key="preview" class="fresh" url={preview.url} alt={words.previewAlt} />
          ) : (
            <Picture key="portrait" class="placeholder" url={pictureUrl(job, kind)} alt="" />
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
      {Progress && job.status === 'running' && <Progress job={job} />}
    </>
  );
}

function Back({ to }: { to: string }) {
  return (
    <a class="button" href={to}>
      {words.back}
    </a>
  );
}

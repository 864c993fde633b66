/** A finished job: its video beside the performance, downloads, and what the run has to say. */

import type { Artifact, Job } from '../../api';
import { type PortraitReport, portraitOptions } from './types';
import { size } from '../../language/format';
import type { ResultProps } from '../../kind/kind';
import { performanceUrl } from '../../performances/drivers';
import { words as portraitWords } from './words';
import { strings } from '../../language/strings';
import { ElapsedTime, ResultActions, Warnings } from '../../result/actions';
import { ReactivePlayer } from './reactive_player';
import { OtherMoods } from './other_moods';
import { Player } from '../../result/player';
import './styles/result.css';

const words = portraitWords.result;

/** The animation, where it has a format that browsers show: a video or a moving picture, not a zip of frames. */
function animation(job: Job): [string, Artifact] | null {
  const shown = ([name, artifact]: [string, Artifact]): boolean =>
    name.startsWith('animation.') && /^(video|image)\//.test(artifact.content_type);
  return Object.entries(job.artifacts).find(shown) ?? null;
}

export default function PortraitResult({ job, report }: ResultProps) {
  const driver = (report as PortraitReport | null)?.inputs.driver_chosen ?? null;
  const found = animation(job);
  const profile = job.artifacts['profile.json'];
  const bundle = job.artifacts['profile.zip'];
  const main = bundle ? (['profile.zip', bundle] as const) : found;

  return (
    <div class="result">
      {profile ? (
        <ReactivePlayer profile={profile.url} poster={job.artifacts['poster.jpg']?.url} />
      ) : found ? (
        <Animation job={job} artifact={found[1]} chosen={driver} />
      ) : (
        <p>{words.otherKind}</p>
      )}
      <ResultActions job={job} filesOpen={!found}>
        {main && (
          <a class="button primary" href={main[1].url} download={main[0]}>
            {profile ? words.downloadProfile : strings.job.download} <small>{size(main[1].size)}</small>
          </a>
        )}
      </ResultActions>
      {!profile && <OtherMoods job={job} />}
      <Warnings report={report} />
      <ElapsedTime job={job} />
    </div>
  );
}

function Animation({ job, artifact, chosen }: { job: Job; artifact: Artifact; chosen: string | null }) {
  if (artifact.content_type.startsWith('image/')) {
    return (
      <figure class="still">
        <img src={artifact.url} alt={words.alt} />
      </figure>
    );
  }
  return (
    <Player
      result={artifact.url}
      alt={words.alt}
      poster={job.artifacts['poster.jpg']?.url}
      driver={performanceUrl(job, chosen)}
      chosen={chosen}
      start={portraitOptions(job).trim?.[0] ?? 0}
      hasSound={portraitOptions(job).sound === true}
    />
  );
}

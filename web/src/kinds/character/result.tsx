/** A finished character: the video, the character itself to take along, and what the run has to say. */

import { type Artifact, getJob, type Job } from '../../api';
import { characterOptions } from './types';
import { getSkeleton } from '../../viewer/artifacts/skeleton';
import { size } from '../../language/format';
import { useLoaded } from '../../api/loading';
import { peopleOf } from '../../viewer/artifacts/people';
import { ElapsedTime, ResultActions, Warnings } from '../../result/actions';
import { Player } from '../../result/player';
import type { ResultProps } from '../../kind/kind';
import { Viewer } from '../../viewer/part';
import { words as characterWords } from './words';

const words = characterWords.character;

export default function CharacterResult({ job, report, onPropose }: ResultProps) {
  const { artifacts } = job;
  const several = peopleOf(job, null).length > 1;
  const skeleton = useLoaded(async (signal) => (several ? getSkeleton(job, signal) : null), job.id).value;
  const film = Object.entries(artifacts).find(([name]) => name.startsWith('animation.'));
  const shown = film && !film[1].content_type.endsWith('/zip') && <Film job={job} artifact={film[1]} />;
  return (
    <div class="result">
      {artifacts['character.glb'] ? (
        <Viewer
          job={job}
          renew={(signal) => getJob(job.id, signal)}
          first="wall"
          pose={characterOptions(job).pose ?? undefined}
          onPose={(pose) => onPropose({ pose })}
          film={shown || undefined}
        />
      ) : (
        shown
      )}
      <ResultActions job={job} filesOpen={!film}>
        {peopleOf(job, skeleton).map(({ name, number }) => (
          <Download key={name} job={job} name={`${name}.glb`} label={several ? words.glbOf(number) : words.glb} primary />
        ))}
        <Download job={job} name="character.usdz" label={words.usdz} />
        <Download job={job} name="character.vrm" label={words.vrm1} />
        <Download job={job} name="lit.png" label={words.litPicture} />
        {film && <Download job={job} name={film[0]} label={words.video} />}
      </ResultActions>
      <Warnings report={report} />
      <ElapsedTime job={job} />
    </div>
  );
}

function Film({ job, artifact }: { job: Job; artifact: Artifact }) {
  if (artifact.content_type.startsWith('image/')) {
    return (
      <figure class="still">
        <img src={artifact.url} alt={words.result} />
      </figure>
    );
  }
  return (
    <Player
      label={words.player}
      alt={words.result}
      result={artifact.url}
      poster={job.artifacts['poster.jpg']?.url}
      driver={null}
      chosen={null}
      start={0}
      hasSound={false}
    />
  );
}

/** Nothing where the job left no file of that name. */
function Download({ job, name, label, primary }: { job: Job; name: string; label: string; primary?: boolean }) {
  const file = job.artifacts[name];
  if (!file) return null;
  return (
    <a class={primary ? 'button primary' : 'button'} href={file.url} download={name}>
      {label} <small>{size(file.size)}</small>
    </a>
  );
}

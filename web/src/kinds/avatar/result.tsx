/** A finished avatar: it in 3D with its expressions, its films, what was measured, and its files. */

import { useState } from 'preact/hooks';
import { getJob, getReport, type Job } from '../../api';
import { useLoaded } from '../../api/loading';
import type { ResultProps } from '../../kind/kind';
import { ElapsedTime, ResultActions, Warnings } from '../../result/actions';
import { Download } from '../../result/download';
import { Player } from '../../result/player';
import type { Character } from '../../viewer/scene/character';
import type { Stage } from '../../viewer/scene/stage';
import { Viewer } from '../../viewer/part';
import { later } from '../../widgets/lazy';
import { fileUrl, isFileId } from '../../works/inputs';
import { Toggles } from '../../widgets/toggles';
import type { AvatarReport } from './types';
import { words as avatarWords } from './words';
import './styles/result.css';

const Measured = later(() => import('./measured'));
const Expressions = later(() => import('../../viewer/expressions/panel'));
const words = avatarWords.show;

/** What can be looked at, and the file without which there is none. */
const views = {
  model: 'avatar.glb',
  animation: 'animation.mp4',
  turntable: 'turntable.mp4',
  measured: 'preview.ply',
  texture: 'texture.png',
} as const;
type View = keyof typeof views;

const expressions = (stage: Stage, character: Character) => <Expressions stage={stage} character={character} />;

export default function AvatarResult({ job }: ResultProps) {
  const report = useLoaded((signal) => getReport<AvatarReport>(job, signal), job.id);
  const shown = (Object.keys(views) as View[]).filter((view) => views[view] in job.artifacts);
  const [view, setView] = useState<View | undefined>(shown[0]);
  return (
    <div class="result">
      <div class="avatar-shown">
        {shown.length > 1 && (
          <Toggles label={words.label} choices={shown} name={(one) => words.names[one]} chosen={view} onChoose={setView} />
        )}
        {shown.includes('model') && (
          <div hidden={view !== 'model'}>
            <Viewer job={job} renew={(signal) => getJob(job.id, signal)} first="look" beside={expressions} />
          </div>
        )}
        {(view === 'animation' || view === 'turntable') && <Film key={view} job={job} view={view} />}
        {view === 'measured' && <Measured job={job} />}
        {view === 'texture' && (
          <figure class="panel avatar-texture">
            <img src={job.artifacts[views.texture]?.url} alt={words.textureAlt} />
          </figure>
        )}
      </div>
      <ResultActions job={job} filesOpen={shown.length === 0}>
        <Download job={job} name="avatar.glb" label={words.glb} primary />
        <Download job={job} name="avatar.usdz" label={words.usdz} />
        <Download job={job} name="avatar.vrm" label={words.vrm} />
        <Download job={job} name="texture.png" label={words.texture} />
        <Download job={job} name="turntable.mp4" label={words.turntable} />
        <Download job={job} name="animation.mp4" label={words.animation} />
      </ResultActions>
      <Warnings report={report.value} />
      <ElapsedTime job={job} />
    </div>
  );
}

/** The animation has the driver beside it, where there is one. */
function Film({ job, view }: { job: Job; view: 'animation' | 'turntable' }) {
  const { driver } = job.inputs;
  return (
    <Player
      label={words.player}
      alt={avatarWords.result}
      result={job.artifacts[views[view]]?.url ?? ''}
      poster={view === 'turntable' ? job.artifacts['poster.jpg']?.url : undefined}
      driver={view === 'animation' && isFileId(driver) ? fileUrl(driver) : null}
      chosen={null}
      start={0}
      hasSound={false}
    />
  );
}

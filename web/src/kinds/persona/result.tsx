/** A finished persona: it playing, in 3D, its average and its expressions, whose faces it was made of, and its files. */

import { useState } from 'preact/hooks';
import { getJob, type Job } from '../../api';
import type { ResultProps } from '../../kind/kind';
import { useKind } from '../../kind/kinds';
import { performanceUrl } from '../../performances/drivers';
import { OtherPerformances } from '../../performances/other_performances';
import { labelOf } from '../../performances/performance_card';
import { ElapsedTime, ResultActions, Warnings } from '../../result/actions';
import { Download } from '../../result/download';
import { Player } from '../../result/player';
import { useSteadyUrl } from '../../widgets/steady_url';
import { Viewer } from '../../viewer/part';
import type { Character } from '../../viewer/scene/character';
import type { Stage } from '../../viewer/scene/stage';
import { later } from '../../widgets/lazy';
import { workName } from '../../works/names';
import { Toggles } from '../../widgets/toggles';
import { usePersonaDraft } from './draft';
import { FaceList } from './faces/face_list';
import { useFaces } from './faces/use_faces';
import { ExpressionGallery } from './gallery';
import { carriedOver, personaOptions } from './types';
import { words as personaWords } from './words';
import './styles/result.css';

const Expressions = later(() => import('./puppet/expressions'));
const words = personaWords.show;

/** What can be looked at, and the file without which there is none. */
const views = {
  animation: 'animation.mp4',
  still: 'still.png',
  model: 'puppet.glb',
  average: 'average.png',
  gallery: 'gallery.jpg',
  angles: 'angles.jpg',
  light: 'average_light.jpg',
  faces: 'faces.json',
} as const;
type View = keyof typeof views;
type Still = 'still' | 'average' | 'angles' | 'light';
const stills: readonly string[] = ['still', 'average', 'angles', 'light'] satisfies Still[];
const isStill = (view: View): view is Still => stills.includes(view);

/** Beside the model. */
const expressionsOf = (job: Job) => (stage: Stage, character: Character) => <Expressions job={job} stage={stage} character={character} />;

export default function PersonaResult({ job, report }: ResultProps) {
  const shown = (Object.keys(views) as View[]).filter((view) => views[view] in job.artifacts);
  const [view, setView] = useState<View | undefined>(shown[0]);
  return (
    <div class="result">
      <div class="persona-shown">
        {shown.length > 1 && (
          <Toggles label={words.label} choices={shown} name={(one) => words.names[one]} chosen={view} onChoose={setView} />
        )}
        {view === 'animation' && <Film job={job} />}
        {view === 'model' && <Viewer job={job} renew={(signal) => getJob(job.id, signal)} first="look" beside={expressionsOf(job)} />}
        {view && isStill(view) && <Picture key={view} job={job} view={view} />}
        {view === 'gallery' && <ExpressionGallery job={job} />}
        {view === 'faces' && <FoundFaces job={job} />}
      </div>
      <ResultActions job={job} filesOpen={shown.length === 0}>
        <Download job={job} name="animation.mp4" label={words.video} primary />
        <Download job={job} name="still.png" label={words.picture} primary />
        <Download job={job} name="puppet.glb" label={words.glb} />
        <Download job={job} name="persona.npz" label={words.persona} />
        <Download job={job} name="average.png" label={words.averageFile} />
      </ResultActions>
      <Another job={job} />
      <Warnings report={report} />
      <ElapsedTime job={job} />
    </div>
  );
}

function Film({ job }: { job: Job }) {
  const { trim, sound, composite } = personaOptions(job);
  return (
    <Player
      result={job.artifacts['animation.mp4']?.url ?? ''}
      alt={personaWords.result}
      poster={job.artifacts['poster.jpg']?.url}
      driver={composite === 'side_by_side' ? null : performanceUrl(job)}
      chosen={null}
      start={trim?.[0] ?? 0}
      hasSound={sound === true}
    />
  );
}

function Picture({ job, view }: { job: Job; view: Still }) {
  const url = useSteadyUrl(job.artifacts[views[view]]);
  return (
    <figure class={`panel persona-picture ${view}`}>
      <img src={url} alt={words.alts[view]} />
      <figcaption>{words.captions[view]}</figcaption>
      {view === 'light' && <RelitPhotos job={job} />}
    </figure>
  );
}

const RELIT = /^average_light_\d+\.png$/;

/** Those that were asked for. */
function RelitPhotos({ job }: { job: Job }) {
  const names = Object.keys(job.artifacts).filter((name) => RELIT.test(name));
  return (
    <ul class="relit-photos plain">
      {names.map((name) => (
        <li key={name}>
          <a href={job.artifacts[name]?.url ?? ''}>
            <img src={job.artifacts[name]?.url ?? ''} alt={words.relit} loading="lazy" />
          </a>
        </li>
      ))}
    </ul>
  );
}

function FoundFaces({ job }: { job: Job }) {
  const faces = useFaces(job);
  return faces ? <FaceList faces={faces} /> : <div aria-busy="true" />;
}

/** The persona in another performance: a built-in one at a click, a video by way of the studio. */
function Another({ job }: { job: Job }) {
  const kind = useKind(job.kind);
  const [, change] = usePersonaDraft();
  const name = workName(job, kind);
  return (
    <>
      <OtherPerformances
        title={words.another}
        kind={job.kind}
        played={job.inputs.driver}
        request={(driver) => ({
          inputs: { persona: job.id, driver: driver.name },
          options: carriedOver(personaOptions(job)),
          metadata: { picture: name, performance: labelOf(driver) },
        })}
      />
      <div class="actions">
        <a class="button" href={kind.link} onClick={() => change({ from: 'persona', persona: { id: job.id, name } })}>
          {words.ownVideo}
        </a>
      </div>
    </>
  );
}

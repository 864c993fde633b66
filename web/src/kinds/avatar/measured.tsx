/** What is known of somebody, as soon as it is: the frames that were chosen, the cloud, where the camera stood, the fitted shape, and
 * its texture. */

import { readArtifact } from '../../api';
import { useLoaded } from '../../api/loading';
import type { ProgressProps } from '../../kind/kind';
import { later } from '../../widgets/lazy';
import { type CapturedCameras, clipNames } from './types';
import { words as avatarWords } from './words';
import './styles/measured.css';

const CloudView = later(() => import('../../viewer/cloud/cloud_view'));
const words = avatarWords.progress;

export default function Measured({ job }: ProgressProps) {
  const { artifacts } = job;
  const points = artifacts['preview.ply'];
  const texture = artifacts['texture_preview.jpg'];
  const cameras = useLoaded(
    (signal) => readArtifact<CapturedCameras>(job, 'cameras.json', signal),
    pathOf(artifacts['cameras.json']?.url),
  ).value;
  return (
    <div class="measured">
      {points && (
        <CloudView
          points={points.url}
          cameras={Object.values(cameras ?? {}).flat()}
          shape={artifacts['fitted.ply']?.url}
          shapeFirst={job.status === 'running'}
        />
      )}
      {texture && job.status === 'running' && (
        <figure class="panel">
          <img src={texture.url} alt={words.texture} />
          <figcaption>{words.texture}</figcaption>
        </figure>
      )}
      {clipNames.map((clip) => {
        const sheet = artifacts[`${clip}_frames.jpg`];
        return (
          sheet && (
            <figure key={clip} class="panel">
              <img src={sheet.url} alt={words.frames[clip]} />
              <figcaption>{words.frames[clip]}</figcaption>
            </figure>
          )
        );
      })}
    </div>
  );
}

/** Links are signed anew whenever the job is told of: the file is the same until its path is another. */
const pathOf = (url: string | undefined): string => url?.split('?')[0] ?? '';

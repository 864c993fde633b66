/** What a job left, shown by what it is: pictures, videos, sounds, 3D models; the rest is files. */

import type { Artifact } from '../../api';
import { later } from '../../widgets/lazy';
import { strings } from '../../language/strings';

const Model = later(() => import('./model'));
const words = strings.job;

/** Pictures that stand for a result, and are shown only where there is nothing else to see. */
const STAND_INS = /^(thumbnail|preview|poster)\.jpg$/;
const SHOWN = /^(image|video|audio)\/|^model\/gltf-binary$/;

export type Artifacts = Readonly<Record<string, Artifact>>;

/** Names of what can be seen or heard, the animation first. */
export function shownIn(artifacts: Artifacts): string[] {
  const all = Object.keys(artifacts).filter((name) => SHOWN.test(artifacts[name]!.content_type));
  const own = all.filter((name) => !STAND_INS.test(name));
  const animations = own.filter((name) => name.startsWith('animation.'));
  const shown = [...animations, ...own.filter((name) => !animations.includes(name))];
  return shown.length ? shown : all.filter((name) => name === 'preview.jpg');
}

interface Props {
  artifacts: Artifacts;
  /** What they show. */
  alt: string;
}

export function ShownArtifacts({ artifacts, alt }: Props) {
  return (
    <>
      {shownIn(artifacts).map((name) => (
        <figure key={name} class="still">
          <ShownArtifact artifact={artifacts[name]!} poster={artifacts['poster.jpg']?.url} alt={`${alt}, ${name}`} />
        </figure>
      ))}
    </>
  );
}

function ShownArtifact({ artifact: { url, content_type: type }, poster, alt }: { artifact: Artifact; poster: string | undefined; alt: string }) {
  if (type.startsWith('image/')) return <img src={url} alt={alt} />;
  if (type.startsWith('video/')) return <video src={url} poster={poster} controls loop playsInline aria-label={alt} />;
  if (type.startsWith('audio/')) return <audio src={url} controls aria-label={alt} />;
  return <Model url={url} alt={`${words.result}: ${strings.generic.model}`} />;
}

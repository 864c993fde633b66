/** What a puppet's face can do, with the collection's own textures for it. */

import { useEffect } from 'preact/hooks';
import type { MeshStandardMaterial } from 'three';
import { readArtifact } from '../../../api';
import type { HasArtifacts } from '../../../viewer/artifacts/people';
import ExpressionPanel from '../../../viewer/expressions/panel';
import type { Character } from '../../../viewer/scene/character';
import type { Stage } from '../../../viewer/scene/stage';
import { BlendedTextures, loadAtlas } from './blended_textures';
import type { PuppetTextures } from './texture_shares';

interface Props {
  job: HasArtifacts;
  stage: Stage;
  character: Character;
}

export default function PuppetExpressions({ job, stage, character }: Props) {
  useEffect(() => {
    const stop = new AbortController();
    const { signal } = stop;
    const blend = async (): Promise<void> => {
      const url = job.artifacts['puppet_textures.jpg']?.url;
      const told = await readArtifact<PuppetTextures>(job, 'puppet_textures.json', signal);
      if (!url || !told) return;
      const atlas = await loadAtlas(url);
      if (signal.aborted) return atlas.dispose();
      const skin = new BlendedTextures(character.mesh.material as MeshStandardMaterial, atlas, told);
      const leave = character.face.watch((weights) => {
        skin.show(weights);
        stage.invalidate();
      });
      signal.addEventListener('abort', () => {
        leave();
        skin.dispose();
      });
    };
    blend().catch(() => undefined); // the face moves without them, too
    return () => stop.abort();
  }, [character]);
  return <ExpressionPanel stage={stage} character={character} />;
}

/** What a public link shows of a persona: it playing, or the picture of it, and it in 3D where it has a model. */

import type { SharedProps } from '../../kind/kind';
import { Viewer } from '../../viewer/part';
import { later } from '../../widgets/lazy';
import { words as personaWords } from './words';

const Expressions = later(() => import('./puppet/expressions'));

export default function SharedPersona({ shared, renew, film }: SharedProps) {
  const picture = shared.artifacts['still.png'];
  const shown = film ?? (picture && <img src={picture.url} alt={personaWords.show.alts.still} />);
  if (!shared.artifacts['puppet.glb']) return shown ?? null;
  return (
    <Viewer
      job={shared}
      renew={renew}
      first={shown ? 'film' : 'look'}
      film={shown}
      beside={(stage, character) => <Expressions job={shared} stage={stage} character={character} />}
    />
  );
}

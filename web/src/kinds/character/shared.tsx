/** What a public link shows of characters: them in 3D, their video at hand. */

import { later } from '../../widgets/lazy';
import type { SharedProps } from '../../kind/kind';

const Viewer = later(() => import('../../viewer/panel'));

export default function SharedCharacter({ shared, renew, film }: SharedProps) {
  if (!shared.artifacts['character.glb']) return film ?? null;
  return <Viewer job={shared} renew={renew} first="wall" film={film} />;
}

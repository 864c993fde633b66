/** What a public link shows of characters: them in 3D, their video at hand. */

import type { SharedProps } from '../../kind/kind';
import { Viewer } from '../../viewer/part';

export default function SharedCharacter({ shared, renew, film }: SharedProps) {
  if (!shared.artifacts['character.glb']) return film ?? null;
  return <Viewer job={shared} renew={renew} first="wall" film={film} />;
}

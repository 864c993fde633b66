/** What a public link shows of a persona: it playing, and it in 3D where it has a model. */

import type { SharedProps } from '../../kind/kind';
import { Viewer } from '../../viewer/part';

export default function SharedPersona({ shared, renew, film }: SharedProps) {
  if (!shared.artifacts['puppet.glb']) return film ?? null;
  return <Viewer job={shared} renew={renew} first="look" film={film} />;
}

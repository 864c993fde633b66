/** What a public link shows of an avatar: it in 3D, its film at hand. */

import type { SharedProps } from '../../kind/kind';
import { Viewer } from '../../viewer/part';

export default function SharedAvatar({ shared, renew, film }: SharedProps) {
  if (!shared.artifacts['avatar.glb']) return film ?? null;
  return <Viewer job={shared} renew={renew} first="look" film={film} />;
}

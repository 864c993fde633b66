/** What a public link to a job of any kind shows. */

import { useKind } from '../../kind/kinds';
import type { SharedProps } from '../../kind/kind';
import { ShownArtifacts } from './artifacts';

export default function SharedArtifacts({ shared }: SharedProps) {
  const { alt } = useKind(shared.kind).shared;
  return <ShownArtifacts artifacts={shared.artifacts} alt={alt} />;
}

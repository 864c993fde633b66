/** What a public link to a job of any kind shows. */

import { kindOf } from '..';
import type { SharedProps } from '../../kind';
import { ShownArtifacts } from './artifacts';

export default function SharedArtifacts({ shared }: SharedProps) {
  return <ShownArtifacts artifacts={shared.artifacts} alt={kindOf(shared.kind).shared.alt} />;
}

/** A file of a result, to be saved. */

import type { Job } from '../api';
import { size } from '../language/format';

interface Props {
  job: Job;
  name: string;
  label: string;
  primary?: boolean;
}

/** Nothing where the job left no file of that name. */
export function Download({ job, name, label, primary = false }: Props) {
  const file = job.artifacts[name];
  if (!file) return null;
  return (
    <a class={primary ? 'button primary' : 'button'} href={file.url} download={name}>
      {label} <small>{size(file.size)}</small>
    </a>
  );
}

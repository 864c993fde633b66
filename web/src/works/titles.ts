/** What works are called by their user. */

import { useEffect, useState } from 'preact/hooks';
import { type Job, renameWork } from '../api';
import { useKind } from '../kind/kinds';
import { pictureName } from './names';

/** A job with the title that its work was given on this page, and what gives it another. */
export function useTitle(job: Job): [Job, (name: string) => Promise<void>] {
  const kind = useKind(job.kind);
  const [title, setTitle] = useState(job.title);
  useEffect(() => setTitle(job.title), [job.title]);
  const rename = async (name: string): Promise<void> => {
    // the name of the picture is what a work without a title has
    setTitle((await renameWork(job.id, name === '' || name === pictureName(job, kind) ? null : name)).title);
  };
  return [{ ...job, title }, rename];
}

/** A job that has ended, again with something changed: only what depends on the change is worked out anew. */

import { useEffect, useState } from 'preact/hooks';
import type { Job } from '../api';
import type { CorrectionsProps, Load } from '../kind/kind';
import { wantsPicture } from './next_step';
import { jobLink } from '../route';
import { strings } from '../language/strings';
import { part } from '../widgets/lazy';

const words = strings.redo;

interface Props extends CorrectionsProps {
  load: Load<CorrectionsProps>;
}

/** Folded away, but for a job that failed for want of a correction alone: there it is what to do next. */
export function Revise({ load, ...given }: Props) {
  const { job, proposal } = given;
  const needed = (job.error?.correctable?.length ?? 0) > 0;
  const [open, setOpen] = useState(needed && !wantsPicture(job));
  useEffect(() => {
    if (proposal) setOpen(true);
  }, [proposal]);
  const Corrections = part(load);
  return (
    <details class="choices revise" open={open} onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary>
        <h2>{needed ? words.mend : words.title}</h2>
      </summary>
      {open && <Corrections {...given} />}
    </details>
  );
}

/** The job and its revisions, to go from one to the other; nothing where there is one alone. */
export function Versions({ job, all }: { job: Job; all: readonly Job[] }) {
  if (all.length < 2) return null;
  return (
    <nav class="versions" aria-label={words.versions}>
      <span>{words.versions}</span>
      {all.map((one, place) => (
        <a key={one.id} href={jobLink(one.id)} aria-current={one.id === job.id ? 'page' : undefined}>
          {place + 1}
        </a>
      ))}
    </nav>
  );
}

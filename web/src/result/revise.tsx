/** A job that has ended, again with something changed: only what depends on the change is worked out anew. */

import { useEffect, useState } from 'preact/hooks';
import { type Job, listRevisions, type Problem } from '../api';
import { useLoaded } from '../loading';
import { jobLink } from '../route';
import { strings } from '../strings';
import { later } from '../widgets/lazy';

const CorrectionPanel = later(() => import('../kinds/portrait/corrections/panel'));
const CharacterPanel = later(() => import('../kinds/character/panel'));
const words = strings.redo;

/** Joints turned on from the pictured pose, by name: degrees about x, y and z. */
export type Pose = Record<string, [number, number, number]>;

interface Props {
  job: Job;
  /** A character's pose, from the viewer, that is to be made. */
  pose: Pose | null;
  onPoseTaken: () => void;
  onProblem: (problem: Problem | null) => void;
}

/** Folded away, but for a job that failed for want of a correction: there it is what to do next. */
export function Redo({ job, pose, onPoseTaken, onProblem }: Props) {
  const needed = (job.error?.correctable?.length ?? 0) > 0;
  const [open, setOpen] = useState(needed);
  useEffect(() => {
    if (pose) setOpen(true);
  }, [pose]);
  return (
    <details class="choices redo" open={open} onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary>
        <h2>{needed ? words.mend : words.title}</h2>
      </summary>
      {open &&
        (job.kind === 'character' ? (
          <CharacterPanel job={job} pose={pose} onPoseTaken={onPoseTaken} onProblem={onProblem} />
        ) : (
          <CorrectionPanel job={job} onProblem={onProblem} />
        ))}
    </details>
  );
}

/** The job and its revisions, to go from one to the other; nothing where there is one alone. */
export function Versions({ job }: { job: Job }) {
  const tree = useLoaded((signal) => listRevisions(job.id, signal), job.id);
  if (!tree.value || tree.value.length < 2) return null;
  return (
    <nav class="versions" aria-label={words.versions}>
      <span>{words.versions}</span>
      {tree.value.map((one, place) => (
        <a key={one.id} href={jobLink(one.id)} aria-current={one.id === job.id ? 'page' : undefined}>
          {place + 1}
        </a>
      ))}
    </nav>
  );
}

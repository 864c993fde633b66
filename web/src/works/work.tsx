/** A work among others: its newest version at large, its name to be changed, and its other versions folded away. */

import { useState } from 'preact/hooks';
import { type Job, listRevisions } from '../api';
import type { Kind } from '../kind/kind';
import { useKind } from '../kind/kinds';
import { differences } from './differences';
import { useLoaded } from '../api/loading';
import { MAX_TITLE_CHARACTERS, workName } from './names';
import { jobLink } from '../route';
import { strings } from '../language/strings';
import { useTitle } from './titles';
import { Details, Poster, State } from './entry';
import { Rename } from '../widgets/rename';
import { ProblemAlert } from '../widgets/problem_alert';

const words = strings.history;

export function Work({ job, versions }: { job: Job; versions: number }) {
  const kind = useKind(job.kind);
  const [titled, rename] = useTitle(job);
  const name = workName(titled, kind);
  return (
    <li class="work">
      <div class="entry">
        <Poster job={job} />
        <Rename name={name} label={words.titleOf(name)} longest={MAX_TITLE_CHARACTERS} onRename={rename}>
          <a class="name" href={jobLink(job.id)} title={name} aria-describedby={`of-${job.id}`}>
            {name}
          </a>
        </Rename>
        <Details id={`of-${job.id}`} job={job} />
      </div>
      {versions > 1 && <Others job={titled} number={versions - 1} />}
    </li>
  );
}

/** The versions beside the one that is shown. */
function Others({ job, number }: { job: Job; number: number }) {
  const kind = useKind(job.kind);
  const [open, setOpen] = useState(false);
  return (
    <details class="other-versions" open={open} onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary>
        {words.others(number)}
        <span class="visually-hidden"> {words.of(workName(job, kind))}</span>
      </summary>
      {open && <Tree job={job} number={number} />}
    </details>
  );
}

function Tree({ job, number }: { job: Job; number: number }) {
  const kind = useKind(job.kind);
  const tree = useLoaded((signal) => listRevisions(job.id, signal), `${job.id} ${number}`);
  if (tree.problem) return <ProblemAlert code={tree.problem.code} detail={tree.problem.detail} />;
  if (!tree.value) return <div class="later" aria-busy="true" />;
  const all = tree.value;
  const place = all.findIndex((version) => version.id === job.id);
  return (
    <>
      {place >= 0 && (
        <p>
          <strong>{words.above(place + 1)}</strong> <span>{changesOf(all[place]!, all, kind)}</span>
        </p>
      )}
      <ol reversed>
        {all
          .map((version, place) => ({ version, place }))
          .reverse()
          .filter(({ version }) => version.id !== job.id)
          .map(({ version, place }) => (
            <li key={version.id}>
              <a href={jobLink(version.id)}>
                <Poster job={version} />
                <span>
                  <strong>{words.version(place + 1)}</strong>
                  <span>{changesOf(version, all, kind)}</span>
                  <State job={version} />
                </span>
              </a>
            </li>
          ))}
      </ol>
    </>
  );
}

/** What a version changed of the one that it revises; nothing where that was erased. */
function changesOf(version: Job, all: readonly Job[], kind: Kind): string {
  if (version.revision_of === null) return words.first;
  const before = all.find((one) => one.id === version.revision_of);
  if (!before) return '';
  const changes = differences(version, before, kind);
  return changes.length ? words.changed(changes.join(', ')) : words.same;
}

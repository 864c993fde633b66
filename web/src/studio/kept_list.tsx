/** What the service keeps for the user under names, to rename and to delete. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { useDoing } from '../api/loading';
import { keptName } from './kept_name';
import { failureRemedy } from '../kind/failures';
import { strings } from '../language/strings';
import { Rename } from '../widgets/rename';
import { ConfirmButton } from '../widgets/confirm';
import '../styles/kept.css';

const words = strings.kept;
const MAX_NAME_CHARACTERS = 63;

export interface KeptItem {
  /** By which it is known again under another name. */
  id: string;
  /** What the service calls it. */
  name: string;
  /** What the page calls it. */
  label: string;
}

interface Props {
  items: readonly KeptItem[];
  rename: (name: string, wanted: string) => Promise<unknown>;
  remove: (name: string) => Promise<void>;
  onRenamed: (name: string, now: string) => void;
  onRemoved: (name: string) => void;
}

export function KeptList({ items, rename, remove, onRenamed, onRemoved }: Props) {
  const [gone, setGone] = useState<string | null>(null);
  const report = useRef<HTMLParagraphElement>(null);
  // The button that had the focus went with its row.
  useEffect(() => {
    if (gone !== null) report.current?.focus();
  }, [gone]);
  return (
    <>
      {items.length > 0 && (
        <details class="kept">
          <summary>{words.manage}</summary>
          <ul>
            {items.map((item) => (
              <Row
                key={item.id}
                item={item}
                onRename={async (typed) => {
                  const wanted = keptName(typed);
                  if (wanted !== item.name) await rename(item.name, wanted);
                  onRenamed(item.name, wanted);
                }}
                onRemove={async () => {
                  await remove(item.name);
                  setGone(item.label);
                  onRemoved(item.name);
                }}
              />
            ))}
          </ul>
        </details>
      )}
      <p class="hint" role="status" tabIndex={-1} ref={report}>
        {gone !== null && words.gone(gone)}
      </p>
    </>
  );
}

interface RowProps {
  item: KeptItem;
  onRename: (typed: string) => Promise<void>;
  onRemove: () => Promise<void>;
}

function Row({ item, onRename, onRemove }: RowProps) {
  const { doing, problem, attempt } = useDoing();
  return (
    <li aria-busy={doing}>
      <Rename name={item.label} label={words.nameOf(item.label)} longest={MAX_NAME_CHARACTERS} onRename={onRename}>
        <span class="label">{item.label}</span>
      </Rename>
      <ConfirmButton
        label={strings.job.remove}
        about={item.label}
        question={words.removeQuestion(item.label)}
        confirmLabel={strings.job.remove}
        onConfirm={() => void attempt(onRemove)}
      />
      {problem && (
        <p class="error" role="alert">
          {failureRemedy(problem.code, problem.detail)}
        </p>
      )}
    </li>
  );
}

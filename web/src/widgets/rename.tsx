/** A name that can be changed where it stands. Enter saves, Escape leaves it as it was. */

import type { ComponentChildren } from 'preact';
import { useEffect, useId, useLayoutEffect, useRef, useState } from 'preact/hooks';
import { useDoing } from '../api/loading';
import { failureRemedy } from '../kind/failures';
import { strings } from '../language/strings';

const words = strings.rename;

interface Props {
  /** What it is called now. */
  name: string;
  /** What the field is for, where it is heard alone. */
  label: string;
  /** Characters, at most. */
  longest: number;
  /** May throw a `Problem`, which is shown beside the field. */
  onRename: (name: string) => Promise<void>;
  /** The name as it is shown while nobody changes it. */
  children: ComponentChildren;
}

export function Rename({ name, label, longest, onRename, children }: Props) {
  const error = useId();
  const [text, setText] = useState<string | null>(null);
  const { doing, problem, attempt, forget } = useDoing();
  const field = useRef<HTMLInputElement>(null);
  const button = useRef<HTMLButtonElement>(null);
  const editing = text !== null;
  const edited = useRef(false);
  // Before anything else is typed: the first letter is to replace the name.
  useLayoutEffect(() => {
    if (editing) field.current?.select();
    else if (edited.current) button.current?.focus();
    edited.current = editing;
  }, [editing]);
  useEffect(() => {
    if (problem) field.current?.focus();
  }, [problem]);

  const leave = (): void => {
    forget();
    setText(null);
  };
  const save = async (): Promise<void> => {
    const wanted = (text ?? '').trim();
    if (doing) return;
    if (wanted === name) leave();
    else {
      await attempt(async () => {
        await onRename(wanted);
        setText(null);
      });
    }
  };

  if (!editing) {
    return (
      <div class="named">
        {children}
        <button
          type="button"
          ref={button}
          class="tool pencil"
          aria-label={`${words.rename}: ${name}`}
          title={words.rename}
          onClick={() => setText(name)}
        >
          <svg viewBox="0 0 24 24" width="18" height="18" aria-hidden="true">
            <path d="M4 20l1-4L16.5 4.5a2.1 2.1 0 0 1 3 3L8 19l-4 1M14.5 6.5l3 3" />
          </svg>
        </button>
      </div>
    );
  }
  return (
    // No form of its own: it may stand within one, which Enter is not to send.
    <div class="renaming" role="group" aria-label={label}>
      <input
        ref={field}
        aria-label={label}
        aria-invalid={problem !== null}
        aria-describedby={problem ? error : undefined}
        maxLength={longest}
        readOnly={doing}
        value={text}
        onInput={({ currentTarget }) => setText(currentTarget.value)}
        onKeyDown={(event) => {
          if (event.isComposing || (event.key !== 'Enter' && event.key !== 'Escape')) return;
          event.preventDefault();
          if (event.key === 'Enter') void save();
          else leave();
        }}
      />
      <div class="actions">
        <button type="button" class="button small primary" aria-disabled={doing} onClick={() => void save()}>
          {words.save}
        </button>
        <button type="button" class="button small" onClick={leave}>
          {strings.cancel}
        </button>
      </div>
      {problem && (
        <p id={error} class="error" role="alert">
          {failureRemedy(problem.code, problem.detail)}
        </p>
      )}
    </div>
  );
}

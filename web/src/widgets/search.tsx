/** Words to search for: what is typed is searched for when the typing rests, or at once by Enter. */

import { useEffect, useId, useRef, useState } from 'preact/hooks';

const REST_MS = 300;

interface Props {
  label: string;
  hint: string;
  longest: number;
  /** What is searched for. */
  value: string;
  onSearch: (words: string) => void;
}

export function SearchField({ label, hint, longest, value, onSearch }: Props) {
  const id = useId();
  const [text, setText] = useState(value);
  /** What this field searched for last: another value comes from elsewhere, as by the browser's Back. */
  const searched = useRef(value);
  const timer = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  const ask = (words: string): void => {
    clearTimeout(timer.current);
    if (words === searched.current) return;
    searched.current = words;
    onSearch(words);
  };
  useEffect(() => {
    if (value === searched.current) return;
    clearTimeout(timer.current);
    searched.current = value;
    setText(value);
  }, [value]);
  useEffect(() => () => clearTimeout(timer.current), []);

  return (
    <form
      class="search"
      role="search"
      onSubmit={(event) => {
        event.preventDefault();
        ask(text.trim());
      }}
    >
      <label class="visually-hidden" for={id}>
        {label}
      </label>
      <svg viewBox="0 0 24 24" width="20" height="20" aria-hidden="true">
        <path d="M16 16l5 5M3 10.5a7.5 7.5 0 1 0 15 0a7.5 7.5 0 1 0-15 0" />
      </svg>
      <input
        id={id}
        type="search"
        placeholder={hint}
        maxLength={longest}
        autocomplete="off"
        value={text}
        onInput={({ currentTarget }) => {
          const { value: typed } = currentTarget;
          setText(typed);
          clearTimeout(timer.current);
          timer.current = setTimeout(() => ask(typed.trim()), REST_MS);
        }}
      />
    </form>
  );
}

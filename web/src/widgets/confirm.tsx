/** A step without a way back, taken only after a question. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { strings } from '../strings';

interface Props {
  label: string;
  /** What the step is about, for those who hear the button by itself. */
  about?: string;
  question: string;
  yes: string;
  onYes: () => void;
}

export function Sure({ label, about, question, yes, onYes }: Props) {
  const [asking, setAsking] = useState(false);
  const keep = useRef<HTMLButtonElement>(null);
  const first = useRef<HTMLButtonElement>(null);
  const asked = useRef(false);
  useEffect(() => {
    if (asking) keep.current?.focus();
    else if (asked.current) first.current?.focus();
    asked.current = asking;
  }, [asking]);

  if (!asking) {
    return (
      <button
        type="button"
        ref={first}
        class="button quiet"
        aria-label={about && `${label}: ${about}`}
        onClick={() => setAsking(true)}
      >
        {label}
      </button>
    );
  }
  return (
    <div class="removal" role="group" aria-label={question}>
      <span>{question}</span>
      <button
        type="button"
        class="button danger"
        onClick={() => {
          setAsking(false);
          onYes();
        }}
      >
        {yes}
      </button>
      <button type="button" class="button" ref={keep} onClick={() => setAsking(false)}>
        {strings.keep}
      </button>
    </div>
  );
}

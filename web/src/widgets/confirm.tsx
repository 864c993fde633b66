/** A step without a way back, taken only after a question. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { strings } from '../language/strings';

interface Props {
  label: string;
  /** What the step is about, for those who hear the button by itself. */
  about?: string;
  question: string;
  confirmLabel: string;
  onConfirm: () => void;
}

export function ConfirmButton({ label, about, question, confirmLabel, onConfirm }: Props) {
  const [asking, setAsking] = useState(false);
  const cancel = useRef<HTMLButtonElement>(null);
  const opener = useRef<HTMLButtonElement>(null);
  const wasAsking = useRef(false);
  useEffect(() => {
    if (asking) cancel.current?.focus();
    else if (wasAsking.current) opener.current?.focus();
    wasAsking.current = asking;
  }, [asking]);

  if (!asking) {
    return (
      <button
        type="button"
        ref={opener}
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
          onConfirm();
        }}
      >
        {confirmLabel}
      </button>
      <button type="button" class="button" ref={cancel} onClick={() => setAsking(false)}>
        {strings.cancel}
      </button>
    </div>
  );
}

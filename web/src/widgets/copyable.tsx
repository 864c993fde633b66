/** Something to be taken along as it stands: an address, a key, a secret. */

import { useEffect, useId, useRef, useState } from 'preact/hooks';
import { strings } from '../language/strings';

interface Props {
  label: string;
  value: string;
  /** Hidden until it is asked for. */
  secret?: boolean;
}

export function Copyable({ label, value, secret = false }: Props) {
  const id = useId();
  const field = useRef<HTMLInputElement>(null);
  const [copied, setCopied] = useState(false);
  const [shown, setShown] = useState(!secret);
  useEffect(() => setCopied(false), [value]);

  const copy = async (): Promise<void> => {
    try {
      await navigator.clipboard.writeText(value);
      setCopied(true);
    } catch {
      setShown(true); // an insecure page may not use the clipboard: it is chosen, to be copied by hand
      field.current?.select();
    }
  };
  return (
    <div class="copyable">
      <label for={id}>{label}</label>
      <div>
        <input
          id={id}
          ref={field}
          type={(shown ? 'text' : 'password') as 'text'}
          autocomplete="off"
          readOnly
          value={value}
          onFocus={({ currentTarget }) => currentTarget.select()}
        />
        {secret && (
          <button type="button" class="toggle" aria-pressed={shown} onClick={() => setShown(!shown)}>
            {strings.reveal}
          </button>
        )}
        <button type="button" class="toggle" onClick={() => void copy()}>
          {copied ? strings.copied : strings.copy}
        </button>
      </div>
      <span class="visually-hidden" role="status">
        {copied ? strings.copied : ''}
      </span>
    </div>
  );
}

/** Where files are dropped or browsed for: what is in it is up to whoever uses it. */

import type { ComponentChildren } from 'preact';
import { useState } from 'preact/hooks';

interface Props {
  /** Of what is dropped: image, video, motion. */
  class: string;
  accept: string;
  many?: boolean;
  label: string;
  /** The id of what is wrong with the files that were given last, where something is. */
  error: string | undefined;
  onDrop: (data: DataTransfer) => void;
  onBrowse: (files: readonly File[]) => void;
  children: ComponentChildren;
}

export function DropTarget({ class: name, accept, many = false, label, error, onDrop, onBrowse, children }: Props) {
  const [over, setOver] = useState(false);
  return (
    <div class={`dropzone ${name} ${over ? 'over' : ''}`}>
      <label
        onDragOver={(event) => {
          event.preventDefault();
          setOver(true);
        }}
        onDragLeave={() => setOver(false)}
        onDrop={(event) => {
          event.preventDefault();
          setOver(false);
          if (event.dataTransfer) onDrop(event.dataTransfer);
        }}
      >
        <input
          type="file"
          accept={accept}
          multiple={many}
          aria-label={label}
          aria-invalid={error !== undefined}
          aria-describedby={error}
          onChange={({ currentTarget }) => {
            onBrowse([...(currentTarget.files ?? [])]);
            currentTarget.value = ''; // so that choosing the same file again counts as a choice
          }}
        />
        {children}
      </label>
    </div>
  );
}

export function Invitation({ drop, browse }: { drop: string; browse: string }) {
  return (
    <span class="prompt" aria-hidden="true">
      <svg viewBox="0 0 24 24" width="28" height="28">
        <path d="M12 16V4m0 0L7 9m5-5 5 5M4 16v3a1 1 0 0 0 1 1h14a1 1 0 0 0 1-1v-3" />
      </svg>
      <strong>{drop}</strong>
      <span>{browse}</span>
    </span>
  );
}

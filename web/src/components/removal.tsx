/** Deleting, in two steps: there is no way back. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { strings } from '../strings';

const words = strings.job;

export function Removal({ onRemove }: { onRemove: () => void }) {
  const [asking, setAsking] = useState(false);
  const keep = useRef<HTMLButtonElement>(null);
  useEffect(() => keep.current?.focus(), [asking]);

  if (!asking) {
    return (
      <button type="button" class="button quiet" onClick={() => setAsking(true)}>
        {words.remove}
      </button>
    );
  }
  return (
    <div class="removal" role="group" aria-label={words.removeQuestion}>
      <span>{words.removeQuestion}</span>
      <button type="button" class="button danger" onClick={onRemove}>
        {words.removeYes}
      </button>
      <button type="button" class="button" ref={keep} onClick={() => setAsking(false)}>
        {words.removeNo}
      </button>
    </div>
  );
}

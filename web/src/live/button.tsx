/** The button that opens a live portrait. Not there where browsers give no camera. */

import { useState } from 'preact/hooks';
import { mayUseCamera } from '../camera/stream';
import { later } from '../widgets/lazy';
import { words } from './words';

const LiveDialog = later(() => import('./dialog'));

interface Props {
  portrait: File | null;
  onTake: (portrait: File, take: File) => void;
}

export function DriveLive({ portrait, onTake }: Props) {
  const [open, setOpen] = useState(false);
  if (!mayUseCamera()) return null;
  return (
    <>
      <button type="button" class="button" title={words.openHint} disabled={!portrait} onClick={() => setOpen(true)}>
        <svg viewBox="0 0 24 24" width="20" height="20" aria-hidden="true">
          <path d="M12 9a3 3 0 1 1 0 6 3 3 0 0 1 0-6M7.8 7.8a6 6 0 0 0 0 8.4m8.4-8.4a6 6 0 0 1 0 8.4M4.9 4.9a10 10 0 0 0 0 14.2M19.1 4.9a10 10 0 0 1 0 14.2" />
        </svg>
        {words.open}
      </button>
      {open && portrait && (
        <LiveDialog
          portrait={portrait}
          onClose={() => setOpen(false)}
          onTake={(take) => {
            setOpen(false);
            onTake(portrait, take);
          }}
        />
      )}
    </>
  );
}

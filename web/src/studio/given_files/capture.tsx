/** A button that opens the camera; what it takes comes as a file. Not there where browsers give no camera. */

import { useState } from 'preact/hooks';
import { mayUseCamera } from '../../camera/stream';
import { strings } from '../../language/strings';
import { later } from '../../widgets/lazy';

const windows = {
  image: later(() => import('../../camera/picture_capture')),
  video: later(() => import('../../camera/recorder')),
};
const words = { image: strings.camera.openPicture, video: strings.camera.openRecorder };
const signs = {
  image: 'M4 8h3l2-3h6l2 3h3v11H4zM12 10a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7',
  video: 'M4 7h10v10H4zm10 4 6-3v8l-6-3z',
};

interface Props {
  media: 'image' | 'video';
  /** Whom a picture is of. */
  of?: 'face' | 'body';
  onFile: (file: File) => void;
}

export function Capture({ media, of = 'face', onFile }: Props) {
  const [open, setOpen] = useState(false);
  if (!mayUseCamera()) return null;
  const Camera = windows[media];
  return (
    <>
      <button type="button" class="button capture" onClick={() => setOpen(true)}>
        <svg viewBox="0 0 24 24" width="20" height="20" aria-hidden="true">
          <path d={signs[media]} />
        </svg>
        {words[media]}
      </button>
      {open && (
        <Camera
          of={of}
          onClose={() => setOpen(false)}
          onFile={(file) => {
            setOpen(false);
            onFile(file);
          }}
        />
      )}
    </>
  );
}

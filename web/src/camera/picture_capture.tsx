/** A picture taken with the camera: of one's face, or of somebody whole. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { ProblemAlert } from '../widgets/problem_alert';
import { Dialog } from '../widgets/dialog';
import { strings } from '../language/strings';
import { useCamera } from './stream';
import { Viewfinder } from './viewfinder';
import '../styles/camera.css';

const words = strings.camera;
const SIZE = { width: { ideal: 1920 }, height: { ideal: 1440 } };
/** One's face is before the screen, somebody whole is seen from behind it. */
const WANTED = { face: { facingMode: 'user', ...SIZE }, body: { facingMode: 'environment', ...SIZE } };

interface Props {
  of: 'face' | 'body';
  onFile: (file: File) => void;
  onClose: () => void;
}

export default function PictureCapture({ of, onFile, onClose }: Props) {
  const { stream, trouble, retry } = useCamera(WANTED[of], false);
  const video = useRef<HTMLVideoElement>(null);
  const [ready, setReady] = useState(false);
  const [taken, setTaken] = useState<{ file: File; url: string } | null>(null);
  useEffect(() => () => URL.revokeObjectURL(taken?.url ?? ''), [taken]);

  const take = async (): Promise<void> => {
    const file = video.current && (await frameOf(video.current));
    if (file) setTaken({ file, url: URL.createObjectURL(file) });
  };
  return (
    <Dialog title={words.pictureTitle} class="compact camera" onClose={onClose}>
      {trouble ? (
        <ProblemAlert code={trouble} detail="">
          <button type="button" class="button" onClick={retry}>
            {strings.retry}
          </button>
        </ProblemAlert>
      ) : (
        <div class="view">
          <Viewfinder stream={stream} video={video} guide={!taken && of === 'face'} onReady={() => setReady(true)} />
          {taken && <img src={taken.url} alt={words.takenAlt} />}
        </div>
      )}
      <p class="hint" role="status">
        {taken ? words.takenHints[of] : words.pictureHints[of]}
      </p>
      <footer class="actions">
        {taken ? (
          <>
            <button type="button" class="button" onClick={() => setTaken(null)}>
              {words.again}
            </button>
            <button type="button" class="button primary" onClick={() => onFile(taken.file)}>
              {words.usePicture}
            </button>
          </>
        ) : (
          <button type="button" class="button primary" disabled={!ready} onClick={() => void take()}>
            {words.take}
          </button>
        )}
      </footer>
    </Dialog>
  );
}

/** What a video shows at this moment, the right way round, as a JPEG. */
async function frameOf(video: HTMLVideoElement): Promise<File | null> {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
  canvas.getContext('2d')?.drawImage(video, 0, 0);
  const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, 'image/jpeg', 0.95));
  return blob && new File([blob], `${words.pictureName}.jpg`, { type: 'image/jpeg' });
}

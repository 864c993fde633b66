/** A performance of one's own, recorded with the camera. */

import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { ProblemAlert } from '../widgets/problem_alert';
import { Dialog } from '../widgets/dialog';
import { clock } from '../language/format';
import { strings } from '../language/strings';
import { LONGEST_SECONDS, useRecording } from './recording';
import { useCamera } from './stream';
import { Viewfinder } from './viewfinder';
import '../styles/camera.css';

const words = strings.camera;
const WANTED = { facingMode: 'user', width: { ideal: 1280 }, height: { ideal: 720 }, frameRate: { ideal: 30 } };

interface Props {
  onFile: (file: File) => void;
  onClose: () => void;
}

export default function PerformanceRecorder({ onFile, onClose }: Props) {
  const [sound, setSound] = useState(false);
  const { stream, trouble, retry } = useCamera(WANTED, sound);
  const video = useRef<HTMLVideoElement>(null);
  const [ready, setReady] = useState(false);
  const { recording, begin, stop, reset } = useRecording(stream, words.recordingName);
  const file = recording.state === 'done' ? recording.file : null;

  return (
    <Dialog title={words.recordTitle} class="compact camera" onClose={onClose}>
      {trouble ? (
        <ProblemAlert code={trouble} detail="">
          <button type="button" class="button" onClick={retry}>
            {strings.retry}
          </button>
        </ProblemAlert>
      ) : (
        <div class="view">
          <Viewfinder
            stream={stream}
            video={video}
            guide={recording.state === 'idle'}
            onReady={() => setReady(true)}
          />
          {recording.state === 'counting' && (
            <p class="countdown" aria-hidden="true">
              {recording.left}
            </p>
          )}
          {recording.state === 'running' && (
            <p class="elapsed" aria-hidden="true">
              {clock(recording.seconds, LONGEST_SECONDS)} / {clock(LONGEST_SECONDS, LONGEST_SECONDS)}
            </p>
          )}
          {file && <Review file={file} />}
        </div>
      )}
      <p class="hint" role="status">
        {words.recordHints[recording.state]}
      </p>
      <footer class="actions">
        {recording.state === 'idle' && (
          <label class="check">
            <input type="checkbox" checked={sound} onChange={() => setSound(!sound)} />
            <span>{words.withSound}</span>
          </label>
        )}
        <span class="spacer" />
        {recording.state === 'idle' && (
          <button type="button" class="button primary" disabled={!ready || !stream} onClick={begin}>
            {words.record}
          </button>
        )}
        {recording.state === 'counting' && (
          <button type="button" class="button" onClick={reset}>
            {words.giveUp}
          </button>
        )}
        {recording.state === 'running' && (
          <button type="button" class="button primary" onClick={stop}>
            {words.stop}
          </button>
        )}
        {file && (
          <>
            <button type="button" class="button" onClick={reset}>
              {words.again}
            </button>
            <button type="button" class="button primary" onClick={() => onFile(file)}>
              {words.useRecording}
            </button>
          </>
        )}
      </footer>
    </Dialog>
  );
}

function Review({ file }: { file: File }) {
  const url = useMemo(() => URL.createObjectURL(file), [file]);
  useEffect(() => () => URL.revokeObjectURL(url), [url]);
  return <video src={url} controls autoPlay loop playsInline aria-label={words.reviewAlt} />;
}

/** A portrait that follows the visitor's camera, in a window over the studio; a take of it is kept as a video of the visitor. */

import { useEffect, useRef } from 'preact/hooks';
import { LONGEST_SECONDS, useRecording } from '../camera/recording';
import { useCamera } from '../camera/stream';
import { Viewfinder } from '../camera/viewfinder';
import { clock } from '../language/format';
import { strings } from '../language/strings';
import { Dialog } from '../widgets/dialog';
import { ProblemAlert } from '../widgets/problem_alert';
import { livePage } from './page_link';
import { useLive } from './use_live';
import { words } from './words';
import './styles/live.css';

const WANTED = { facingMode: 'user', width: { ideal: 1280 }, height: { ideal: 720 }, frameRate: { ideal: 30 } };

interface Props {
  portrait: File;
  /** A take that is to be kept. */
  onTake: (take: File) => void;
  onClose: () => void;
}

export default function LiveDialog({ portrait, onTake, onClose }: Props) {
  const { stream, trouble, retry } = useCamera(WANTED, false);
  const video = useRef<HTMLVideoElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const { state, problem, live, rate, again, recalibrate } = useLive(portrait, stream, video, canvas);
  const { recording, beginNow, stop } = useRecording(stream, words.takeName);
  useEffect(() => {
    if (recording.state === 'done') onTake(recording.file);
  }, [recording]);

  const running = recording.state === 'running';
  const moving = state.step === 'live' || state.step === 'no_face';
  const told = running ? words.recording : (state.obstacle && words.obstacles[state.obstacle]) || words.states[state.step];
  return (
    <Dialog title={words.title} class="compact live" onClose={onClose}>
      {trouble && (
        <ProblemAlert code={trouble} detail="">
          <button type="button" class="button" onClick={retry}>
            {strings.retry}
          </button>
        </ProblemAlert>
      )}
      {problem && (
        <ProblemAlert code={problem.code} detail={problem.detail}>
          <button type="button" class="button" onClick={again}>
            {words.again}
          </button>
        </ProblemAlert>
      )}
      <div class="view" hidden={Boolean(trouble)}>
        <canvas ref={canvas} role="img" aria-label={words.alt} width="4" height="4" data-state={state.step} />
        <div class="self">
          <Viewfinder stream={stream} video={video} guide={state.step === 'calibrating'} onReady={() => undefined} />
        </div>
        {moving && (
          <p class="rate" aria-hidden="true">
            {words.rate(rate)}
          </p>
        )}
        {running && (
          <p class="elapsed" aria-hidden="true">
            {clock(recording.seconds, LONGEST_SECONDS)}
          </p>
        )}
      </div>
      {state.step === 'calibrating' && <progress aria-label={words.progress} max={1} value={state.fraction} />}
      <p class="hint" role="status">
        {told}
      </p>
      <footer class="actions">
        <button type="button" class="button" disabled={!moving || running} onClick={recalibrate}>
          {words.recalibrate}
        </button>
        {live && !problem && (
          <a class="button" href={livePage(live)} target="_blank" rel="noopener" title={words.aloneHint}>
            {words.alone}
          </a>
        )}
        <span class="spacer" />
        <button type="button" class="button primary" disabled={!moving && !running} onClick={running ? stop : beginNow}>
          {running ? words.stop : words.record}
        </button>
      </footer>
    </Dialog>
  );
}

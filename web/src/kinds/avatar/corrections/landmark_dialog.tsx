/** A window in which joints are shown in frames of the body clip, where they were not found well. */

import { useEffect, useId, useRef, useState } from 'preact/hooks';
import { clock } from '../../../language/format';
import { Dialog } from '../../../widgets/dialog';
import { type FrameSheet, picturesOf } from '../types';
import { words as avatarWords } from '../words';
import type { Landmarks } from './changes';
import { jointNames, landmarkName, placeIn, withPlace } from './landmarks';
import { cellStyle } from '../../../widgets/sheet_cell';

const words = avatarWords.place;
/** Seconds into a frame, so that it is not the one before that is seen. */
const INTO_FRAME = 0.004;
/** Steps of an arrow key, and of one with Shift, in shares of the frame's height. */
const [STEP, WIDE_STEP] = [0.002, 0.02];

interface Props {
  sheet: FrameSheet;
  /** Where the sheet's picture is, and the clip. */
  sheetUrl: string;
  clip: string | null;
  /** Joints that the job asks for. */
  doubtful: readonly string[];
  start: Landmarks;
  onDone: (landmarks: Landmarks) => void;
  onClose: () => void;
}

export default function LandmarkDialog({ sheet, sheetUrl, clip, doubtful, start, onDone, onClose }: Props) {
  const [landmarks, setLandmarks] = useState(start);
  const offered = [...new Set([...doubtful, ...jointNames, ...Object.keys(start)])];
  const [joint, setJoint] = useState(offered[0] ?? 'Nose');
  const [place, setPlace] = useState(0);
  const frame = sheet.frames[place] ?? 0;
  const here = placeIn(landmarks, joint, frame);
  const put = (at: readonly [number, number] | null): void => setLandmarks(withPlace(landmarks, joint, frame, at));
  const jointId = useId();
  const helpId = useId();
  return (
    <Dialog title={words.title} onClose={onClose}>
      <div class="place-tools">
        <label for={jointId}>{words.joint}</label>
        <select id={jointId} value={joint} onChange={({ currentTarget }) => setJoint(currentTarget.value)}>
          {offered.map((name) => (
            <option key={name} value={name}>
              {words.count(landmarkName(name), landmarks[name]?.length ?? 0)}
            </option>
          ))}
        </select>
        <FrameSlider sheet={sheet} place={place} onPlace={setPlace} />
      </div>
      <Frame
        sheet={sheet}
        sheetUrl={sheetUrl}
        clip={clip}
        place={place}
        label={words.stage(landmarkName(joint))}
        help={helpId}
        points={Object.keys(landmarks).flatMap((name) => {
          const at = placeIn(landmarks, name, frame);
          return at ? [{ at, chosen: name === joint }] : [];
        })}
        here={here}
        onPut={put}
      />
      <p class="hint" id={helpId}>
        {words.help}
      </p>
      <div class="actions">
        <button type="button" class="button quiet" disabled={!here} onClick={() => put(null)}>
          {words.clear}
        </button>
        <span class="spacer" />
        <button type="button" class="button" onClick={onClose}>
          {words.cancel}
        </button>
        <button type="button" class="button primary" onClick={() => onDone(landmarks)}>
          {words.done}
        </button>
      </div>
    </Dialog>
  );
}

function FrameSlider({ sheet, place, onPlace }: { sheet: FrameSheet; place: number; onPlace: (place: number) => void }) {
  const last = sheet.frames.length - 1;
  const told = avatarWords.correct.frame(place + 1, clock(sheet.seconds[place] ?? 0, sheet.seconds[last] ?? 0));
  return (
    <>
      <button type="button" class="toggle" disabled={place === 0} onClick={() => onPlace(place - 1)}>
        {words.before}
      </button>
      <input
        type="range"
        min="0"
        max={last}
        step="1"
        value={place}
        aria-label={words.frame}
        aria-valuetext={told}
        onInput={({ currentTarget }) => onPlace(currentTarget.valueAsNumber)}
      />
      <button type="button" class="toggle" disabled={place === last} onClick={() => onPlace(place + 1)}>
        {words.next}
      </button>
      <output>{told}</output>
    </>
  );
}

interface FrameProps extends Pick<Props, 'sheet' | 'sheetUrl' | 'clip'> {
  place: number;
  label: string;
  /** The id of what is said of it. */
  help: string;
  points: readonly { at: readonly [number, number]; chosen: boolean }[];
  here: readonly [number, number] | null;
  onPut: (at: readonly [number, number]) => void;
}

/** A frame of the clip itself, where the browser plays it; the small one of the sheet is seen until then. */
function Frame({ sheet, sheetUrl, clip, place, label, help, points, here, onPut }: FrameProps) {
  const video = useRef<HTMLVideoElement>(null);
  const [unplayable, setUnplayable] = useState(clip === null);
  const [width, height] = sheet.size;
  useEffect(() => {
    if (video.current) video.current.currentTime = (sheet.seconds[place] ?? 0) + INTO_FRAME;
  }, [place, unplayable]);
  const bounded = (x: number, y: number): [number, number] => [rounded(x, width), rounded(y, height)];
  const click = (event: MouseEvent & { currentTarget: Element }): void => {
    const box = event.currentTarget.getBoundingClientRect();
    onPut(bounded(((event.clientX - box.left) / box.width) * width - 0.5, ((event.clientY - box.top) / box.height) * height - 0.5));
  };
  const key = (event: KeyboardEvent): void => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!way) return;
    event.preventDefault();
    const step = height * (event.shiftKey ? WIDE_STEP : STEP);
    const [x, y] = here ?? [width / 2, height / 2];
    onPut(bounded(x + way[0]! * step, y + way[1]! * step));
  };
  return (
    <>
      <div
        class="place-stage"
        style={{ '--aspect': width / height }}
        role="application"
        tabIndex={0}
        aria-label={label}
        aria-describedby={help}
        onClick={click}
        onKeyDown={key}
      >
        <div style={cellStyle(picturesOf(sheet), sheetUrl, place)} />
        {clip && !unplayable && (
          <video
            ref={video}
            src={clip}
            muted
            playsInline
            preload="auto"
            aria-hidden="true"
            tabIndex={-1}
            onLoadedMetadata={({ currentTarget }) => {
              currentTarget.currentTime = (sheet.seconds[place] ?? 0) + INTO_FRAME;
            }}
            onError={() => setUnplayable(true)}
          />
        )}
        <svg viewBox={`-0.5 -0.5 ${width} ${height}`} aria-hidden="true">
          {points.map(({ at: [x, y], chosen }, index) => (
            <path key={index} class={chosen ? 'chosen' : ''} d={`M${x} ${y}h0`} />
          ))}
        </svg>
      </div>
      {unplayable && <p class="hint">{words.unreadable}</p>}
    </>
  );
}

/** Within a side of so many pixels, to a tenth of one. */
const rounded = (value: number, side: number): number => Math.round(10 * Math.min(side - 0.5, Math.max(-0.5, value))) / 10;

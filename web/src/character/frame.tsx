/** A frame around the person, drawn over the picture: a window of its own over the page. */

import { useId, useReducer, useState } from 'preact/hooks';
import type { Frame } from '../api';
import { Window } from '../components/window';
import { begun, step } from '../stage/history';
import { inside, type Point } from '../stage/place';
import { type Drag, Surface, type Touch } from '../stage/surface';
import { HistoryTools, historyKey, StageFooter, ZoomTools } from '../stage/tools';
import { type View, whole, zoomed } from '../stage/view';
import { strings } from '../strings';
import { enlarged, frameBetween, movedFrame, rounded } from './framing';
import '../styles/stage.css';

const words = strings.framePerson;

/** What one press of a key does, as a share of the picture's longer side. */
const NUDGE = 1 / 100;

interface Props {
  url: string;
  size: readonly [width: number, height: number];
  start: Frame;
  onDone: (frame: Frame) => void;
  onClose: () => void;
}

export default function FrameEditor({ url, size, start, onDone, onClose }: Props) {
  const picture = whole(...size);
  const [history, advance] = useReducer(step<Frame>, start, begun<Frame>);
  const [view, setView] = useState<View>(picture);
  const help = useId();
  const frame = history.state;
  const [x, y, width, height] = frame;
  const box = { x, y, width, height };

  const change = (state: Frame): void => {
    advance({ type: 'begin' });
    advance({ type: 'change', state });
  };
  const zoom = (factor: number | null): void =>
    setView(factor === null ? picture : zoomed(view, factor, [x + width / 2, y + height / 2], picture));
  const grasp = ({ at: from, reach }: Touch): Drag => {
    advance({ type: 'begin' });
    const corner = oppositeOf(frame, from, reach);
    const made = (at: Point): Frame => {
      if (corner) return frameBetween(corner, at, size);
      return inside(box, from) ? movedFrame(frame, at[0] - from[0], at[1] - from[1], size) : frameBetween(from, at, size);
    };
    return {
      move: (at) => advance({ type: 'change', state: made(at) }),
      cancel: () => advance({ type: 'change', state: frame }),
    };
  };
  const key = (event: KeyboardEvent): void => {
    const unit = Math.max(...size) * NUDGE;
    const alter = (dx: number, dy: number) => (): void =>
      change(event.shiftKey ? enlarged(frame, dx, dy, size) : movedFrame(frame, dx, dy, size));
    const actions: Record<string, () => void> = {
      arrowleft: alter(-unit, 0),
      arrowright: alter(unit, 0),
      arrowup: alter(0, -unit),
      arrowdown: alter(0, unit),
      '+': () => zoom(1.5),
      '-': () => zoom(1 / 1.5),
    };
    const command = event.ctrlKey || event.metaKey;
    const action = command ? historyKey(event, advance) : actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  };

  const told = rounded(frame);
  return (
    <Window title={words.title} onClose={onClose}>
      <div class="stage-tools" role="toolbar" aria-label={words.tools}>
        <ZoomTools onZoom={zoom} />
        <HistoryTools history={history} advance={advance} />
      </div>
      <Surface
        class="framing"
        size={size}
        view={view}
        label={words.stage}
        help={help}
        onGrasp={grasp}
        onView={setView}
        onKey={key}
      >
        <image href={url} x="-0.5" y="-0.5" width={size[0]} height={size[1]} preserveAspectRatio="none" />
        <path
          class="outside"
          d={`M-0.5-0.5h${size[0]}v${size[1]}h${-size[0]}zM${x} ${y}v${height}h${width}v${-height}z`}
        />
        <rect class="frame" {...box} />
        {[x, x + width].flatMap((cx) =>
          [y, y + height].map((cy) => <path key={`${cx} ${cy}`} class="handle" d={`M${cx} ${cy}h0`} />),
        )}
      </Surface>
      <p class="stage-help" id={help}>
        {words.help} <span class="keys">{words.keys}</span>
      </p>
      <p class="unseen" role="status">
        {words.box(told[2], told[3], told[0], told[1])}
      </p>
      <StageFooter
        canReset={frame !== start}
        onReset={() => change(start)}
        onCancel={onClose}
        onDone={() => onDone(told)}
      />
    </Window>
  );
}

/** The corner that stays where another is dragged; null where none is within reach. */
function oppositeOf([x, y, width, height]: Frame, [px, py]: Point, reach: number): Point | null {
  for (const [cx, ox] of [
    [x, x + width],
    [x + width, x],
  ] as const) {
    for (const [cy, oy] of [
      [y, y + height],
      [y + height, y],
    ] as const) {
      if (Math.hypot(px - cx, py - cy) <= reach) return [ox, oy];
    }
  }
  return null;
}

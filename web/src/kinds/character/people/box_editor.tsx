/** A frame around the person, drawn over the picture: a window of its own over the page. */

import { useId } from 'preact/hooks';
import type { Frame } from '../../../api';
import { act, arrows, useEditing, zoomKeys } from '../../../picture_editor/editing';
import { EditorDialog } from '../../../picture_editor/editor_dialog';
import { inside, type Point } from '../../../picture_editor/geometry';
import { type Drag, Surface, type Touch } from '../../../picture_editor/surface';
import { enlarged, frameBetween, movedFrame, rounded } from './boxes';
import { words as characterWords } from '../words';

const words = characterWords.framePerson;

/** What one press of a key does, as a share of the picture's longer side. */
const NUDGE = 1 / 100;

interface Props {
  url: string;
  size: readonly [width: number, height: number];
  start: Frame;
  onDone: (frame: Frame) => void;
  onClose: () => void;
}

export default function BoxEditor({ url, size, start, onDone, onClose }: Props) {
  const { history, advance, state: frame, change, view, setView, zoom } = useEditing(size, start);
  const help = useId();
  const [x, y, width, height] = frame;
  const box = { x, y, width, height };
  const zoomTo = (factor: number | null): void => zoom(factor, [x + width / 2, y + height / 2]);

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
    const alter = event.shiftKey ? enlarged : movedFrame;
    const moves = arrows(Math.max(...size) * NUDGE, (dx, dy) => change(alter(frame, dx, dy, size)));
    act(event, { ...moves, ...zoomKeys(zoomTo) }, advance);
  };

  const told = rounded(frame);
  return (
    <EditorDialog
      title={words.title}
      toolsLabel={words.tools}
      history={history}
      advance={advance}
      onZoom={zoomTo}
      help={{ id: help, text: words.help, keys: words.keys }}
      canReset={frame !== start}
      onReset={() => change(start)}
      onClose={onClose}
      onDone={() => onDone(told)}
    >
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
      <p class="visually-hidden" role="status">
        {words.box(told[2], told[3], told[0], told[1])}
      </p>
    </EditorDialog>
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

/** The joints of a person, to be dragged where they belong: a window of its own over the page. */

import { useId, useMemo, useState } from 'preact/hooks';
import { Checkbox } from '../../../widgets/checkbox';
import { act, arrows, useEditing, zoomKeys } from '../../../picture_editor/editing';
import { EditorDialog } from '../../../picture_editor/editor_dialog';
import { Magnifier } from '../../../picture_editor/magnifier';
import { boxAround, middle, moved, resized } from '../../../picture_editor/transforms';
import { boxOf, grown, inside, nearest, type Point } from '../../../picture_editor/geometry';
import { type Drag, Surface, type Touch } from '../../../picture_editor/surface';
import { Tool } from '../../../picture_editor/tools';
import { around } from '../../../picture_editor/view';
import { isDetail, type Joints, labelOf, sharesOf, swapped } from './skeleton';
import { SkeletonDrawing } from './skeleton_drawing';
import { words as characterWords } from '../words';

const words = characterWords.joints;

/** How far one press of a key moves, as a share of the picture's longer side. */
const NUDGE = 1 / 600;
/** How many times as far it moves with Shift. */
const SHIFT_FACTOR = 8;
const GROW = 1.03;
/** Pixels of the screen between the skeleton and the frame around it. */
const MARGIN = 22;

interface Props {
  url: string;
  size: readonly [width: number, height: number];
  /** Where the joints are to begin with. */
  start: Joints;
  /** Whether they were found, or only stand there to be placed. */
  found: boolean;
  onDone: (joints: Joints) => void;
  onClose: () => void;
}

export default function JointEditor({ url, size, start, found, onDone, onClose }: Props) {
  const names = useMemo(() => Object.keys(start), [start]);
  const near = found ? around.bind(null, boxOf(Object.values(start)), 0.15) : undefined;
  const { history, advance, state: joints, change, view, setView, zoom } = useEditing(size, start, near);
  const [all, setAll] = useState(!found);
  const [details, setDetails] = useState(false);
  const [chosen, setChosen] = useState<string | null>(null);
  const [scale, setScale] = useState(1);
  const [hand, setHand] = useState<'left' | 'right' | null>(null);
  const help = useId();
  const points = names.map((name) => joints[name] ?? ([0, 0] as const));
  const shown = names.filter((name) => details || !isDetail(name));
  const share = sharesOf(names, all ? null : chosen);
  const box = all ? grown(boxAround(points), MARGIN / scale) : null;
  const handle: Point | null = box && [box.x + box.width, box.y + box.height];

  const named = (places: readonly Point[]): Joints =>
    Object.fromEntries(names.map((name, index) => [name, places[index] ?? [0, 0]]));
  const grow = (factor: number): void => change(named(resized(points, sharesOf(names, null), factor, 0)));
  const zoomTo = (factor: number | null): void =>
    zoom(factor, middle(points, share.some(Boolean) ? share : sharesOf(names, null)));

  const dragging = (taken: string | null, from: Point): Drag => {
    const moving = sharesOf(names, taken);
    advance({ type: 'begin' });
    return {
      move: (at, side) => {
        setHand(side);
        advance({ type: 'change', state: named(moved(points, moving, at[0] - from[0], at[1] - from[1])) });
      },
      end: () => setHand(null),
      cancel: () => setHand(null),
    };
  };
  const growing = (from: Point): Drag => {
    const everything = sharesOf(names, null);
    const [cx, cy] = middle(points, everything);
    const before = Math.max(1e-6, Math.hypot(from[0] - cx, from[1] - cy));
    advance({ type: 'begin' });
    return {
      move: (at) => {
        const factor = Math.max(0.1, Math.hypot(at[0] - cx, at[1] - cy) / before);
        advance({ type: 'change', state: named(resized(points, everything, factor, 0)) });
      },
    };
  };
  const grasp = ({ at, reach }: Touch): Drag | null => {
    if (box && handle) {
      if (Math.hypot(handle[0] - at[0], handle[1] - at[1]) <= reach) return growing(at);
      return inside(box, at) ? dragging(null, at) : null;
    }
    const index = nearest(shown.map((name) => joints[name] ?? [0, 0]), at, reach);
    const taken = index === null ? null : shown[index];
    if (!taken) return null;
    setChosen(taken);
    return dragging(taken, at);
  };

  const key = (event: KeyboardEvent): void => {
    const unit = Math.max(...size) * NUDGE * (event.shiftKey ? SHIFT_FACTOR : 1);
    const moves = arrows(unit, (dx, dy) => {
      if (all || chosen) change(named(moved(points, share, dx, dy)));
    });
    act(event, { ...moves, ...zoomKeys(zoomTo) }, advance);
  };

  const watched = hand && !all && chosen ? joints[chosen] : null;
  const drawing = <SkeletonDrawing joints={joints} shown={shown} chosen={all ? null : chosen} />;
  const image = <image href={url} x="-0.5" y="-0.5" width={size[0]} height={size[1]} preserveAspectRatio="none" />;
  return (
    <EditorDialog
      title={found ? words.title : words.placeTitle}
      toolsLabel={words.tools}
      tools={
        <>
          <Checkbox label={words.whole} checked={all} onChange={setAll} />
          {names.some(isDetail) && <Checkbox label={words.details} checked={details} onChange={setDetails} />}
          {all && (
            <span class="cluster">
              <Tool label={words.smaller} onUse={() => grow(1 / GROW)} icon="M9 4v5H4m11-5v5h5M9 20v-5H4m11 5v-5h5" />
              <Tool label={words.larger} onUse={() => grow(GROW)} icon="M4 9V4h5m6 0h5v5M4 15v5h5m6 0h5v-5" />
            </span>
          )}
          <span class="cluster">
            <Tool label={words.swap} onUse={() => change(swapped(joints))} icon="M4 8h14m0 0-4-4m4 4-4 4M20 16H6m0 0 4-4m-4 4 4 4" />
          </span>
        </>
      }
      history={history}
      advance={advance}
      onZoom={zoomTo}
      help={{
        id: help,
        text: `${all ? words.helpWhole : words.help} ${words.sides}`,
        keys: all ? words.keysWhole : words.keys,
      }}
      canReset={joints !== start}
      onReset={() => change(start)}
      onClose={onClose}
      onDone={() => onDone(joints)}
    >
      <Surface
        class="joints"
        size={size}
        view={view}
        label={words.stage}
        help={help}
        reachable={!all}
        onGrasp={grasp}
        onView={setView}
        onScale={setScale}
        onKey={key}
        over={
          hand &&
          watched && (
            <Magnifier at={watched} scale={scale} hand={hand}>
              {image}
              {drawing}
            </Magnifier>
          )
        }
      >
        {image}
        <SkeletonDrawing
          joints={joints}
          shown={shown}
          chosen={all ? null : chosen}
          onChoose={all ? undefined : setChosen}
        />
        {box && <rect class="frame" {...box} />}
        {handle && <path class="handle" d={`M${handle[0]} ${handle[1]}h0`} />}
      </Surface>
      <p class="chosen-joint" role="status">
        {all ? words.whole : chosen ? labelOf(chosen) : ''}
      </p>
    </EditorDialog>
  );
}

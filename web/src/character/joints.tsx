/** The joints of a person, to be dragged where they belong: a window of its own over the page. */

import { useId, useMemo, useReducer, useState } from 'preact/hooks';
import { Check } from '../components/check';
import { Window } from '../components/window';
import { begun, step } from '../stage/history';
import { Lens } from '../stage/lens';
import { boxAround, middle, moved, resized } from '../stage/moving';
import { boxOf, grown, inside, nearest, type Point } from '../stage/place';
import { type Drag, Surface, type Touch } from '../stage/surface';
import { HistoryTools, historyKey, StageFooter, Tool, ZoomTools } from '../stage/tools';
import { around, type View, whole, zoomed } from '../stage/view';
import { strings } from '../strings';
import { isDetail, type Joints, labelOf, sharesOf, swapped } from './skeleton';
import { SkeletonDrawing } from './drawing';
import '../styles/stage.css';

const words = strings.joints;

/** What one press of a key does, as a share of the picture's longer side; with Shift so many times as far. */
const NUDGE = 1 / 600;
const FAR = 8;
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
  const picture = whole(...size);
  const names = useMemo(() => Object.keys(start), [start]);
  const [history, advance] = useReducer(step<Joints>, start, begun<Joints>);
  const [all, setAll] = useState(!found);
  const [details, setDetails] = useState(false);
  const [chosen, setChosen] = useState<string | null>(null);
  const [view, setView] = useState<View>(() =>
    found ? around(boxOf(Object.values(start)), 0.15, picture) : picture,
  );
  const [scale, setScale] = useState(1);
  const [hand, setHand] = useState<'left' | 'right' | null>(null);
  const help = useId();
  const joints = history.state;
  const points = names.map((name) => joints[name] ?? ([0, 0] as const));
  const shown = names.filter((name) => details || !isDetail(name));
  const share = sharesOf(names, all ? null : chosen);
  const box = all ? grown(boxAround(points), MARGIN / scale) : null;
  const handle: Point | null = box && [box.x + box.width, box.y + box.height];

  const named = (places: readonly Point[]): Joints =>
    Object.fromEntries(names.map((name, index) => [name, places[index] ?? [0, 0]]));
  const change = (state: Joints): void => {
    advance({ type: 'begin' });
    advance({ type: 'change', state });
  };
  const grow = (factor: number): void => change(named(resized(points, sharesOf(names, null), factor, 0)));
  const zoom = (factor: number | null): void =>
    setView(factor === null ? picture : zoomed(view, factor, middle(points, share.some(Boolean) ? share : sharesOf(names, null)), picture));

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
    const unit = Math.max(...size) * NUDGE * (event.shiftKey ? FAR : 1);
    const nudge = (dx: number, dy: number) => (): void => {
      if (all || chosen) change(named(moved(points, share, dx, dy)));
    };
    const actions: Record<string, () => void> = {
      arrowleft: nudge(-unit, 0),
      arrowright: nudge(unit, 0),
      arrowup: nudge(0, -unit),
      arrowdown: nudge(0, unit),
      '+': () => zoom(1.5),
      '=': () => zoom(1.5),
      '-': () => zoom(1 / 1.5),
    };
    const command = event.ctrlKey || event.metaKey;
    const action = command ? historyKey(event, advance) : actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  };

  const watched = hand && !all && chosen ? joints[chosen] : null;
  const drawing = <SkeletonDrawing joints={joints} shown={shown} chosen={all ? null : chosen} />;
  const image = <image href={url} x="-0.5" y="-0.5" width={size[0]} height={size[1]} preserveAspectRatio="none" />;
  return (
    <Window title={found ? words.title : words.placeTitle} onClose={onClose}>
      <div class="stage-tools" role="toolbar" aria-label={words.tools}>
        <Check label={words.whole} checked={all} onChange={setAll} />
        {names.some(isDetail) && <Check label={words.details} checked={details} onChange={setDetails} />}
        {all && (
          <span class="cluster">
            <Tool label={words.smaller} onUse={() => grow(1 / GROW)} icon="M9 4v5H4m11-5v5h5M9 20v-5H4m11 5v-5h5" />
            <Tool label={words.larger} onUse={() => grow(GROW)} icon="M4 9V4h5m6 0h5v5M4 15v5h5m6 0h5v-5" />
          </span>
        )}
        <span class="cluster">
          <Tool label={words.swap} onUse={() => change(swapped(joints))} icon="M4 8h14m0 0-4-4m4 4-4 4M20 16H6m0 0 4-4m-4 4 4 4" />
        </span>
        <ZoomTools onZoom={zoom} />
        <HistoryTools history={history} advance={advance} />
      </div>
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
            <Lens at={watched} scale={scale} hand={hand}>
              {image}
              {drawing}
            </Lens>
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
      <p class="stage-help" id={help}>
        {all ? words.helpWhole : words.help} {words.sides} <span class="keys">{all ? words.keysWhole : words.keys}</span>
      </p>
      <p class="chosen-joint" role="status">
        {all ? words.whole : chosen ? labelOf(chosen) : ''}
      </p>
      <StageFooter
        canReset={joints !== start}
        onReset={() => change(start)}
        onCancel={onClose}
        onDone={() => onDone(joints)}
      />
    </Window>
  );
}

/** Where the points are dragged: by feature, one by one, or the whole face; with a lens over what moves. */

import { useState } from 'preact/hooks';
import { Magnifier } from '../../../picture_editor/magnifier';
import { boxAround, middle, moved, resized } from '../../../picture_editor/transforms';
import { grown, inside, nearest, type Point } from '../../../picture_editor/geometry';
import { type Drag, Surface, type Touch } from '../../../picture_editor/surface';
import type { View } from '../../../picture_editor/view';
import { LandmarkDrawing } from './landmark_drawing';
import { nearestFeature, type Selection, shares } from './moving';
import { lineOf, type Points } from './scheme';

/** Pixels of the screen between what is chosen and the frame around it. */
const MARGIN = 14;

interface Props {
  url: string;
  size: readonly [width: number, height: number];
  points: Points;
  selection: Selection;
  soft: boolean;
  view: View;
  label: string;
  help: string;
  onView: (view: View) => void;
  onSelect: (selection: Selection) => void;
  onBegin: () => void;
  onPoints: (points: Points) => void;
  onKey: (event: KeyboardEvent) => void;
}

export function LandmarkStage(props: Props) {
  const { url, size, points, selection, soft, view } = props;
  const [width, height] = size;
  const [scale, setScale] = useState(1);
  const [hand, setHand] = useState<'left' | 'right' | null>(null);
  const share = shares(selection, soft);
  const chosen = selection.by === 'point' ? selection.index : null;
  const box = selection.by === 'point' ? null : grown(boxAround(points, share), MARGIN / scale);
  const handle: Point | null = box && [box.x + box.width, box.y + box.height];

  /** What is under a pointer: what a drag from there would move. */
  const under = (at: Point, reach: number): Selection | null => {
    if (selection.by === 'face') return null;
    if (selection.by === 'point') {
      const index = nearest(points, at, reach);
      return index === null ? null : { by: 'point', feature: lineOf(index).feature, index };
    }
    const feature = nearestFeature(points, at, reach);
    return feature && { by: 'feature', feature };
  };

  const grasp = ({ at, reach }: Touch): Drag | null => {
    if (handle && Math.hypot(handle[0] - at[0], handle[1] - at[1]) <= reach) return resize(at);
    const found = under(at, reach);
    if (found) props.onSelect(found);
    const taken = found ?? (box && inside(box, at) ? selection : null);
    return taken && moving(at, shares(taken, soft));
  };
  const moving = (from: Point, share: number[]): Drag => {
    props.onBegin();
    return {
      move: (at, side) => {
        setHand(side);
        props.onPoints(moved(points, share, at[0] - from[0], at[1] - from[1]));
      },
      end: () => setHand(null),
      cancel: () => setHand(null),
    };
  };
  const resize = (from: Point): Drag => {
    props.onBegin();
    const [cx, cy] = middle(points, share);
    const [fromX, fromY] = [from[0] - cx, from[1] - cy];
    return {
      move: (at) => {
        const [toX, toY] = [at[0] - cx, at[1] - cy];
        const factor = Math.max(0.1, Math.hypot(toX, toY) / Math.max(1e-6, Math.hypot(fromX, fromY)));
        const angle = Math.atan2(toY, toX) - Math.atan2(fromY, fromX);
        props.onPoints(resized(points, share, factor, angle));
      },
    };
  };

  const drawing = <LandmarkDrawing url={url} width={width} height={height} points={points} share={share} chosen={chosen} />;
  const watched = chosen === null ? null : points[chosen];
  return (
    <Surface
      class="landmarks"
      size={size}
      view={view}
      label={props.label}
      help={props.help}
      onGrasp={grasp}
      onView={props.onView}
      onScale={setScale}
      onKey={props.onKey}
      over={
        hand &&
        watched && (
          <Magnifier at={watched} scale={scale} hand={hand}>
            {drawing}
          </Magnifier>
        )
      }
    >
      {drawing}
      {box && <rect class="frame" {...box} />}
      {handle && <path class="handle" d={`M${handle[0]} ${handle[1]}h0`} />}
    </Surface>
  );
}

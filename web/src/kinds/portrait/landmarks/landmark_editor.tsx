/** The landmarks of a picture, to be put right by hand: a window of its own over the page. */

import { useId, useMemo, useState } from 'preact/hooks';
import { act, arrows, useEditing } from '../../../picture_editor/editing';
import { EditorDialog } from '../../../picture_editor/editor_dialog';
import { boxAround, middle, moved, resized } from '../../../picture_editor/transforms';
import { Tool } from '../../../picture_editor/tools';
import { around } from '../../../picture_editor/view';
import { words as portraitWords } from '../words';
import { type Selection, shares } from './moving';
import { type Feature, features, membersOf, type Points } from './scheme';
import { LandmarkStage } from './landmark_stage';
import { facePlaced } from './template';

const words = portraitWords.landmarks;

/** How far one press of a key moves, as a share of the picture's longer side. */
const NUDGE = 1 / 600;
/** How many times as far it moves with Shift. */
const SHIFT_FACTOR = 8;
/** What one press of a key, or of a button, does besides: a factor, or radians. */
const GROW = 1.03;
const TURN = Math.PI / 90;

interface Props {
  url: string;
  size: readonly [width: number, height: number];
  /** The points that were found or placed before; null where there are none. */
  found: Points | null;
  onDone: (points: Points) => void;
  onClose: () => void;
}

export default function LandmarkEditor({ url, size, found, onDone, onClose }: Props) {
  const start = useMemo(() => found ?? facePlaced(...size), [found, size]);
  const near = found ? around.bind(null, boxAround(found), 0.2) : undefined;
  const { history, advance, state: points, change, view, setView, zoom } = useEditing(size, start, near);
  const [selection, setSelection] = useState<Selection>(found ? { by: 'feature', feature: 'lips' } : { by: 'face' });
  const [soft, setSoft] = useState(true);
  const [said, setSaid] = useState('');
  const help = useId();
  const share = shares(selection, soft);

  const select = (next: Selection): void => {
    setSelection(next);
    setSaid(nameOf(next));
  };
  const zoomTo = (factor: number | null): void => zoom(factor, middle(points, share));
  const next = (by: 1 | -1): void => select(following(selection, by));

  const key = (event: KeyboardEvent): void => {
    const unit = Math.max(...size) * NUDGE * (event.shiftKey ? SHIFT_FACTOR : 1);
    const actions = {
      ...arrows(unit, (dx, dy) => change(moved(points, share, dx, dy))),
      pageup: () => next(-1),
      pagedown: () => next(1),
      '+': () => change(resized(points, share, GROW, 0)),
      '=': () => change(resized(points, share, GROW, 0)),
      '-': () => change(resized(points, share, 1 / GROW, 0)),
      '[': () => change(resized(points, share, 1, -TURN)),
      ']': () => change(resized(points, share, 1, TURN)),
    };
    act(event, actions, advance);
  };

  const single = selection.by === 'point';
  return (
    <EditorDialog
      title={found ? words.title : words.placeTitle}
      toolsLabel={words.tools}
      tools={
        <>
          <label class="inline">
            <span aria-hidden="true">{words.what}</span>
            <select
              aria-label={words.what}
              value={selection.by === 'face' ? 'face' : selection.feature}
              onChange={({ currentTarget: { value } }) => select(chosenAs(value as Feature | 'face', single))}
            >
              <option value="face">{words.face}</option>
              {features.map((feature) => (
                <option key={feature} value={feature}>
                  {words.features[feature]}
                </option>
              ))}
            </select>
          </label>
          <label class="check">
            <input
              type="checkbox"
              checked={single}
              onChange={({ currentTarget: { checked } }) =>
                select(chosenAs(selection.by === 'face' ? 'lips' : selection.feature, checked))
              }
            />
            <span>{words.single}</span>
          </label>
          {single && (
            <>
              <label class="check">
                <input type="checkbox" checked={soft} onChange={() => setSoft(!soft)} />
                <span>{words.soft}</span>
              </label>
              <span class="cluster">
                <Tool label={words.previous} onUse={() => next(-1)} icon="M15 5 8 12l7 7" />
                <Tool label={words.next} onUse={() => next(1)} icon="m9 5 7 7-7 7" />
              </span>
            </>
          )}
          {!single && (
            <span class="cluster">
              <Tool label={words.smaller} onUse={() => change(resized(points, share, 1 / GROW, 0))} icon="M9 4v5H4m11-5v5h5M9 20v-5H4m11 5v-5h5" />
              <Tool label={words.larger} onUse={() => change(resized(points, share, GROW, 0))} icon="M4 9V4h5m6 0h5v5M4 15v5h5m6 0h5v-5" />
              <Tool label={words.turnLeft} onUse={() => change(resized(points, share, 1, -TURN))} icon="M4 10a8 8 0 1 1 1 7M4 4v6h6" />
              <Tool label={words.turnRight} onUse={() => change(resized(points, share, 1, TURN))} icon="M20 10a8 8 0 1 0-1 7m1-13v6h-6" />
            </span>
          )}
        </>
      }
      history={history}
      advance={advance}
      onZoom={zoomTo}
      help={{
        id: help,
        text: single ? words.helpPoint : selection.by === 'face' ? words.helpFace : words.helpFeature,
        keys: words.keys,
      }}
      canReset={points !== start}
      onReset={() => change(start)}
      onClose={onClose}
      onDone={() => onDone(points)}
    >
      <LandmarkStage
        url={url}
        size={size}
        points={points}
        selection={selection}
        soft={soft}
        view={view}
        label={words.stage}
        help={help}
        onView={setView}
        onSelect={select}
        onBegin={() => advance({ type: 'begin' })}
        onPoints={(changed) => advance({ type: 'change', state: changed })}
        onKey={key}
      />
      <p class="visually-hidden" role="status">
        {said}
      </p>
    </EditorDialog>
  );
}

/** A selection of the same grain elsewhere. */
const chosenAs = (feature: Feature | 'face', single: boolean): Selection => {
  if (feature === 'face') return { by: 'face' };
  return single ? { by: 'point', feature, index: membersOf(feature)[0] ?? 0 } : { by: 'feature', feature };
};

/** The selection after this one or before it, around and around. */
function following(selection: Selection, by: 1 | -1): Selection {
  const around = <T,>(all: readonly T[], one: T): T => all.at((all.indexOf(one) + by) % all.length) as T;
  if (selection.by === 'point') {
    const every = features.flatMap(membersOf);
    const index = around(every, selection.index);
    return { by: 'point', index, feature: features.find((f) => membersOf(f).includes(index)) ?? selection.feature };
  }
  return chosenAs(around(['face', ...features], selection.by === 'face' ? 'face' : selection.feature), false);
}

function nameOf(selection: Selection): string {
  if (selection.by === 'face') return words.face;
  const name = words.features[selection.feature];
  if (selection.by === 'feature') return name;
  const members = membersOf(selection.feature);
  return words.point(name, members.indexOf(selection.index) + 1, members.length);
}

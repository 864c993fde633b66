/** Another pose by hand: joints are dragged, or bones turned by sliders; nothing is made until it is asked for. */

import type { ComponentChildren } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { begun, type History, type Step, step } from '../../picture_editor/history';
import { HistoryTools, historyKey, Tool } from '../../picture_editor/tools';
import { words } from '../words';
import { turnable } from './handles';
import { resetView } from '../orbit/orbit_view';
import { type Degrees, type Pose, rounded } from './pose';
import { PoseEditor } from './pose_editor';
import type { Stage } from '../scene/stage';
import type { StagedCharacter } from '../scene/staging';
const axes = [0, 1, 2] as const;

/** Another pose; where it belongs to the gesture before, both are undone as one. */
const changed = (history: History<Pose>, to: Pose, continues = false): History<Pose> =>
  step(continues ? history : step(history, { type: 'begin' }), { type: 'change', state: to });

interface Props {
  stage: Stage;
  /** Whose joints are dragged. */
  cast: readonly [StagedCharacter];
  /** How many people the pose will be made for. */
  people: number;
  /** The pose to begin with. */
  start: Pose;
  tools: ComponentChildren;
  onPose: (pose: Record<string, Degrees>) => void;
}

export function PosingView({ stage, cast, people, start, tools, onPose }: Props) {
  const [{ character }] = cast;
  const [history, setHistory] = useState<History<Pose>>(() => begun(start));
  const [bone, setBone] = useState('Head');
  const editor = useRef<PoseEditor | null>(null);
  const sliding = useRef(false);
  const pose = history.state;
  const advance = (next: Step<Pose>): void => setHistory((known) => step(known, next));

  useEffect(() => {
    const made = new PoseEditor(stage, character, {
      onGrasp: ({ turns }) => setBone(turns.at(-1) ?? 'Head'),
      onPose: (dragged, continues) => setHistory((known) => changed(known, dragged, continues)),
    });
    editor.current = made;
    made.show(pose);
    resetView(stage, cast);
    return () => made.dispose();
  }, [stage, character]);
  useEffect(() => editor.current?.show(pose), [pose]);

  useEffect(() => {
    const key = (event: KeyboardEvent): void => {
      const act = historyKey(event, advance);
      if (!act) return;
      event.preventDefault();
      act();
    };
    stage.place.addEventListener('keydown', key);
    return () => stage.place.removeEventListener('keydown', key);
  }, [stage]);

  const slide = (axis: 0 | 1 | 2, angle: number): void => {
    const continues = sliding.current;
    sliding.current = true;
    setHistory((known) => {
      const degrees: Degrees = [...(known.state[bone] ?? [0, 0, 0])];
      degrees[axis] = angle;
      return changed(known, { ...known.state, [bone]: degrees }, continues);
    });
  };
  const degrees = pose[bone] ?? [0, 0, 0];
  const names = /Arm|Hand|Shoulder/.test(bone) ? words.armTurns : words.turns;
  const made = rounded(pose);
  const asBefore = JSON.stringify(made) === JSON.stringify(rounded(start));

  return (
    <>
      <fieldset class="viewer-rotations">
        <label class="inline">
          <span>{words.bone}</span>
          <select value={bone} onChange={({ currentTarget: { value } }) => setBone(value)}>
            {turnable.filter((name) => character.joints.has(name)).map((name) => (
              <option key={name} value={name}>
                {words.bones[name] ?? name}
              </option>
            ))}
          </select>
        </label>
        {axes.map((axis) => (
          <label key={axis}>
            <span>{names[axis]}</span>
            <input
              type="range"
              min={axis === 1 ? -90 : -180}
              max={axis === 1 ? 90 : 180}
              step="1"
              value={degrees[axis]}
              aria-valuetext={words.degrees(Math.round(degrees[axis]))}
              onInput={({ currentTarget }) => slide(axis, currentTarget.valueAsNumber)}
              onChange={() => (sliding.current = false)}
            />
          </label>
        ))}
      </fieldset>
      <div class="viewer-tools" role="toolbar" aria-label={words.tools}>
        <HistoryTools history={history} advance={advance} />
        {tools}
        <Tool label={words.reset} onUse={() => resetView(stage, cast)} icon="M4 12 12 5l8 7M7 10v9h10v-9" />
      </div>
      <p class="viewer-help">
        {words.poseHelp} {people > 1 && <strong>{words.poseForAll(people)}</strong>}
      </p>
      <div class="actions">
        <button
          type="button"
          class="button quiet"
          disabled={Object.keys(made).length === 0}
          onClick={() => setHistory((known) => changed(known, {}))}
        >
          {words.asPictured}
        </button>
        <button type="button" class="button primary" disabled={asBefore} onClick={() => onPose(made)}>
          {words.makeIt}
        </button>
      </div>
    </>
  );
}

/** The picture hangs on a wall, and the person steps out of it: on the screen, or in a headset. */

import type { ComponentChildren } from 'preact';
import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { Vector3 } from 'three';
import { PlayButton } from '../../result/transport';
import { words } from '../words';
import { Emergence } from './emergence';
import { hang } from './hanging';
import { prefersStillness } from '../orbit/orbit_view';
import { enter, hasHeadset } from './headset';
import { Room } from './room';
import { ContactShadow } from '../scene/shadow';
import type { Stage } from '../scene/stage';
import type { StagedCharacter } from '../scene/staging';
import { StepOut } from './step_out';
import { Tool } from '../../picture_editor/tools';
import type { PictureView } from '../artifacts/picture_view';
import { VisitorCamera } from './visitor_camera';
/** Metres from the picture at which one enters with a headset. */
const BEFORE = 3;
/** Radians: nobody gets behind the wall or under the floor. */
const ASIDE = 1.3;
const LOWEST = Math.PI / 2 + 0.12;

interface Props {
  stage: Stage;
  cast: readonly StagedCharacter[];
  view: PictureView;
  dark: boolean;
  tools: ComponentChildren;
}

export function WallView({ stage, cast, view, dark, tools }: Props) {
  const hanging = useMemo(() => hang(view.camera), [view]);
  const stepOut = useRef<StepOut | null>(null);
  const takeOff = useRef<(() => void) | null>(null);
  const visitor = useRef<VisitorCamera | null>(null);
  const [playing, setPlaying] = useState(false);
  const [out, setOut] = useState(false);
  const [headset, setHeadset] = useState(false);
  const [refused, setRefused] = useState(false);

  useEffect(() => {
    void hasHeadset().then(setHeadset);
    const { plane, lift, eye } = hanging;
    const depths = cast.map(({ character }) => character.home.z);
    const steppers = cast.map(({ character, rise }) => {
      const { home, root, mesh } = character;
      // whoever is further off in the picture would come to stand behind the wall
      root.position.z = Math.max(0, home.z);
      const away = new Vector3(0, lift + rise, home.z - root.position.z);
      const emergence = new Emergence(mesh, new Vector3(...eye), plane, away, [Math.min(...depths), Math.max(...depths)]);
      return { character, emergence, shadow: new ContactShadow(character) };
    });
    const shadows = steppers.map(({ shadow }) => shadow.object);
    const steps = new StepOut(steppers, (on) => {
      setPlaying(on);
      if (on) setOut(true);
    });
    stepOut.current = steps;
    stage.scene.add(...shadows);
    const leave = [stage.add(steps), ...steppers.map(({ shadow }) => stage.add(shadow))];
    const release = confine(stage);
    const camera = new VisitorCamera(stage, hanging, steps);
    visitor.current = camera;
    leave.push(stage.add(camera));
    if (!prefersStillness()) steps.restart(true);
    return () => {
      takeOff.current?.();
      camera.dispose();
      for (const go of leave) go();
      release();
      stage.scene.remove(...shadows);
      for (const { character, emergence, shadow } of steppers) {
        shadow.dispose();
        emergence.dispose();
        character.unbend();
        character.settle();
      }
    };
  }, [stage, cast, hanging]);

  useEffect(() => {
    const room = new Room(hanging, view.background, dark, () => stage.invalidate());
    stage.scene.add(room.object);
    stage.paint(room.air);
    return () => {
      stage.scene.remove(room.object);
      room.dispose();
    };
  }, [stage, hanging, dark]);

  const act = (change: (stepOut: StepOut) => void): void => {
    if (stepOut.current) change(stepOut.current);
    stage.invalidate();
  };
  const putOn = (): void => {
    setRefused(false);
    const { left, right, plane } = hanging;
    const select = (): void => stepOut.current?.restart(true);
    enter(stage, new Vector3((left + right) / 2, 0, plane + BEFORE), select, () => (takeOff.current = null)).then(
      (leave) => {
        takeOff.current = leave;
        act((steps) => steps.restart(true));
      },
      () => setRefused(true),
    );
  };

  return (
    <>
      <div class="controls">
        <PlayButton playing={playing} onPlay={() => act((steps) => steps.set(!playing))} />
        <button
          type="button"
          class="button"
          onClick={() => {
            act((steps) => steps.restart(false));
            setOut(false);
          }}
        >
          {words.wallBack}
        </button>
        {headset && (
          <button type="button" class="button" onClick={putOn}>
            {words.headset}
          </button>
        )}
      </div>
      <div class="viewer-tools" role="toolbar" aria-label={words.tools}>
        {tools}
        <Tool label={words.reset} onUse={() => visitor.current?.comeBack()} icon="M4 12 12 5l8 7M7 10v9h10v-9" />
      </div>
      {refused && <p role="alert">{words.headsetFailed}</p>}
      <p class="viewer-help">{out ? words.wallOut : words.wallHelp}</p>
    </>
  );
}

/** Keep the camera in the room; call the answer to let it out. */
function confine({ controls }: Stage): () => void {
  controls.minAzimuthAngle = -ASIDE;
  controls.maxAzimuthAngle = ASIDE;
  controls.maxPolarAngle = LOWEST;
  controls.minDistance = 0.8;
  return () => {
    controls.minAzimuthAngle = -Infinity;
    controls.maxAzimuthAngle = Infinity;
    controls.maxPolarAngle = Math.PI;
    controls.minDistance = 0;
  };
}

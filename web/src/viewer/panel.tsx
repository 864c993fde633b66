/** A character in 3D: looked at from all sides, posed by hand, seen in one's own room or stepping out of its picture. */

import type { ComponentChildren } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import type { Job } from '../api';
import { later } from '../components/later';
import { Trouble } from '../components/trouble';
import { useLoaded } from '../loading';
import { strings } from '../strings';
import { useSkeletonLines, useSurroundings, useWideView } from './around';
import type { Character } from './character';
import { Looking } from './looking';
import { type Pose } from './pose';
import { Posing } from './posing';
import type { Stage } from './stage';
import { useStage } from './staging';
import { Tool } from '../stage/tools';
import { getPictureView, type PictureView } from './view';
import { Wall } from './wall';
import '../styles/viewer.css';

const Space = later(() => import('./space'));
const words = strings.viewer;

type Mode = 'look' | 'pose' | 'wall';

export interface ViewerProps {
  job: Job;
  /** Is told a pose that is to be made; without it, poses cannot be edited. */
  onPose?: ((pose: Record<string, [number, number, number]>) => void) | undefined;
}

export default function Viewer({ job, onPose }: ViewerProps) {
  const section = useRef<HTMLElement>(null);
  const place = useRef<HTMLDivElement>(null);
  const { shown, trouble, retry } = useStage(place, job.artifacts['character.glb']?.url);
  const view = useLoaded((signal) => getPictureView(job, signal), job.id).value;
  const [mode, setMode] = useState<Mode>('look');
  const [inSpace, setInSpace] = useState(false);
  const wide = useWideView(section);
  useEffect(() => shown?.stage.hold(inSpace), [shown, inSpace]);
  const modes: Mode[] = ['look', ...(onPose ? ['pose' as const] : []), ...(view ? ['wall' as const] : [])];

  return (
    <section ref={section} class="viewer" aria-label={words.label}>
      <header>
        <div class="actions" role="group" aria-label={words.modes}>
          {modes.length > 1 &&
            modes.map((one) => (
              <button
                key={one}
                type="button"
                class="toggle"
                aria-pressed={one === mode}
                disabled={!shown}
                onClick={() => setMode(one)}
              >
                {words.modeNames[one]}
              </button>
            ))}
        </div>
        <button type="button" class="button" onClick={() => setInSpace(true)}>
          {words.space}
        </button>
      </header>
      {/* The keyboard circles around what is shown: see the help below. */}
      <div
        ref={place}
        class="viewer-stage"
        tabIndex={trouble ? -1 : 0}
        role="application"
        aria-label={words.stage}
        aria-busy={!shown && !trouble}
      >
        {trouble && (
          <Trouble code={trouble} detail={trouble === 'no_webgl' ? words.noWebGL : words.failed}>
            {trouble !== 'no_webgl' && (
              <button type="button" class="button" onClick={retry}>
                {strings.retry}
              </button>
            )}
          </Trouble>
        )}
        {!shown && !trouble && <p class="viewer-loading">{words.loading}</p>}
      </div>
      {shown && (
        <Modes
          {...shown}
          mode={mode}
          view={view}
          pose={posedSoFar(job)}
          onPose={onPose}
          tools={
            wide && (
              <Tool
                label={wide.on ? words.smaller : strings.player.fullScreen}
                onUse={wide.toggle}
                icon={wide.on ? 'M9 4v5H4m11-5v5h5M9 20v-5H4m11 5v-5h5' : 'M4 9V4h5m6 0h5v5M4 15v5h5m6 0h5v-5'}
              />
            )
          }
        />
      )}
      {inSpace && <Space job={job} onClose={() => setInSpace(false)} />}
    </section>
  );
}

interface ModesProps {
  stage: Stage;
  character: Character;
  mode: Mode;
  view: PictureView | null;
  pose: Pose;
  onPose: ViewerProps['onPose'];
  tools: ComponentChildren;
}

function Modes({ stage, character, mode, view, pose, onPose, tools }: ModesProps) {
  const around = useSurroundings(stage, character, mode === 'wall');
  const lines = useSkeletonLines(stage, character, mode === 'look');
  const common = (
    <>
      {mode === 'look' && (
        <Tool label={words.skeleton} pressed={lines.on} onUse={lines.toggle} icon="M12 8v6m0-4.5L7 12m5-2.5L17 12m-5 2-3 7m3-7 3 7M12 3a2.5 2.5 0 1 1 0 5 2.5 2.5 0 0 1 0-5" />
      )}
      <Tool label={around.dark ? words.light : words.dark} onUse={around.toggle} icon="M12 4a8 8 0 1 0 0 16zM12 4a8 8 0 0 1 0 16" />
      {tools}
    </>
  );
  if (mode === 'pose' && onPose) {
    return <Posing stage={stage} character={character} start={pose} tools={common} onPose={onPose} />;
  }
  if (mode === 'wall' && view) return <Wall stage={stage} character={character} view={view} dark={around.dark} tools={common} />;
  return <Looking stage={stage} character={character} tools={common} />;
}

/** The pose that the job was made with. */
const posedSoFar = (job: Job): Pose => (job.options as { pose?: Pose | null }).pose ?? {};

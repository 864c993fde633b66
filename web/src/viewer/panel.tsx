/** Characters in 3D: looked at from all sides, posed by hand, seen in one's own room or stepping out of their picture. */

import type { ComponentChildren } from 'preact';
import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { later } from '../widgets/lazy';
import { ProblemAlert } from '../widgets/problem_alert';
import { strings } from '../language/strings';
import { words } from './words';
import { useSkeletonLines, useSurroundings, useWideView } from './scene/surroundings';
import { OrbitView } from './orbit/orbit_view';
import { peopleOf, standOnFloor, standTogether, type HasArtifacts } from './artifacts/people';
import type { Character } from './scene/character';
import { type Pose } from './posing/pose';
import { PosingView } from './posing/posing_view';
import type { Stage } from './scene/stage';
import { type StagedCharacter, useCast, useStage } from './scene/staging';
import { Tool } from '../picture_editor/tools';
import { PlayButton } from '../result/transport';
import { mayHaveView, type PictureView, viewOf } from './artifacts/picture_view';
import { WallView } from './wall/wall_view';
import { type PersonChoice, PersonSelect } from './person_select';
import './viewer.css';

const ArDialog = later(() => import('./ar/ar_dialog'));

type Mode = 'wall' | 'look' | 'pose' | 'film';

export interface ViewerProps {
  job: HasArtifacts;
  /** Reads the job once more, with links that have only now been signed. */
  renew: (signal: AbortSignal) => Promise<HasArtifacts>;
  /** What is seen first, where the job has what it takes and the browser shows 3D. */
  first: 'wall' | 'look' | 'film';
  /** The pose that they were made with. */
  pose?: Pose | undefined;
  /** Is told a pose that is to be made; without it, poses cannot be edited. */
  onPose?: ((pose: Record<string, [number, number, number]>) => void) | undefined;
  /** Their video: seen at once where there is no 3D. */
  film?: ComponentChildren;
  /** What stands beside a character that is looked at. */
  beside?: ((stage: Stage, character: Character) => ComponentChildren) | undefined;
}

export default function Viewer({ job, renew, first, pose = {}, onPose, film, beside }: ViewerProps) {
  const section = useRef<HTMLElement>(null);
  const place = useRef<HTMLDivElement>(null);
  const { shown, trouble, retry } = useStage(place, job);
  const [chosen, setMode] = useState<Mode>(first);
  const [wanted, setWanted] = useState<PersonChoice>('all');
  const [inSpace, setInSpace] = useState(false);
  const wide = useWideView(section);
  const view = useMemo(() => viewOf(job, shown?.skeleton ?? null), [shown]);
  const flat = trouble === 'no_webgl' && film !== undefined;
  const mode = flat ? 'film' : chosen === 'wall' && shown && !view ? 'look' : chosen;
  useEffect(() => shown?.stage.hold(inSpace || mode === 'film'), [shown, inSpace, mode]);
  const people = shown?.people ?? peopleOf(job, null);
  const together = standTogether(people);
  const who = wanted === 'all' && (mode === 'pose' || !together) ? 0 : wanted;
  const cast = useMemo(() => {
    const all = shown?.standing ?? [];
    return who === 'all' ? all : all.slice(who, who + 1);
  }, [shown, who]);
  useCast(shown, cast);
  const modes: Mode[] = [
    ...(mayHaveView(job) ? ['wall' as const] : []),
    'look',
    ...(onPose ? ['pose' as const] : []),
    ...(film ? ['film' as const] : []),
  ];

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
                disabled={one !== 'film' && (!shown || (one === 'wall' && !view))}
                onClick={() => setMode(one)}
              >
                {words.modeNames[one]}
              </button>
            ))}
        </div>
        {standOnFloor(job) && (
          <button type="button" class="button" onClick={() => setInSpace(true)}>
            {words.space}
          </button>
        )}
        {people.length > 1 && (
          <PersonSelect
            people={people}
            together={shown ? together : 'skeleton.json' in job.artifacts}
            chosen={who}
            disabled={!shown}
            onChoose={setWanted}
          />
        )}
      </header>
      <div class={beside ? 'viewer-scene with-side' : 'viewer-scene'} hidden={mode === 'film'}>
        {/* The keyboard circles around what is shown: see the help below. */}
        <div
          ref={place}
          class="viewer-stage"
          tabIndex={trouble ? -1 : 0}
          role="application"
          aria-label={people.length > 1 ? words.stageOfSeveral : words.stage}
          aria-busy={!shown && !trouble}
        >
          {trouble && !flat && (
            <ProblemAlert code={trouble} detail={trouble === 'no_webgl' ? words.noWebGL : words.failed}>
              {trouble !== 'no_webgl' && (
                <button type="button" class="button" onClick={retry}>
                  {strings.retry}
                </button>
              )}
            </ProblemAlert>
          )}
          {!shown && !trouble && <p class="viewer-loading">{words.loading}</p>}
        </div>
        {beside && shown && mode === 'look' && cast[0] && (
          <div class="viewer-side">{beside(shown.stage, cast[0].character)}</div>
        )}
      </div>
      {mode === 'film' && film}
      {flat && <p class="viewer-help">{words.noWebGL}</p>}
      {!shown && !trouble && mode !== 'film' && <ControlsPlace help={mode === 'wall' ? words.wallHelp : words.help} />}
      {shown && mode !== 'film' && cast.length > 0 && (
        <Modes
          stage={shown.stage}
          cast={cast}
          people={people.length}
          mode={mode}
          view={view}
          pose={pose}
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
      {inSpace && <ArDialog job={job} renew={renew} who={who === 'all' ? 0 : who} onClose={() => setInSpace(false)} />}
    </section>
  );
}

/** As high as the controls that come once somebody stands on the stage: what lies below is not pushed away then. */
const ControlsPlace = ({ help }: { help: string }) => (
  <>
    <div class="controls viewer-awaited" aria-hidden="true">
      <PlayButton playing={false} onPlay={() => undefined} />
    </div>
    <div class="viewer-tools viewer-awaited" aria-hidden="true">
      <Tool label="" onUse={() => undefined} icon="" />
    </div>
    <p class="viewer-help viewer-awaited" aria-hidden="true">
      {help}
    </p>
  </>
);

interface ModesProps {
  stage: Stage;
  cast: readonly StagedCharacter[];
  /** How many were woken. */
  people: number;
  mode: Exclude<Mode, 'film'>;
  view: PictureView | null;
  pose: Pose;
  onPose: ViewerProps['onPose'];
  tools: ComponentChildren;
}

function Modes({ stage, cast, people, mode, view, pose, onPose, tools }: ModesProps) {
  const around = useSurroundings(stage, cast, mode === 'wall');
  const lines = useSkeletonLines(stage, cast, mode === 'look');
  const common = (
    <>
      {mode === 'look' && cast.every(({ character }) => character.stands) && (
        <Tool label={words.skeleton} pressed={lines.on} onUse={lines.toggle} icon="M12 8v6m0-4.5L7 12m5-2.5L17 12m-5 2-3 7m3-7 3 7M12 3a2.5 2.5 0 1 1 0 5 2.5 2.5 0 0 1 0-5" />
      )}
      <Tool label={around.dark ? words.light : words.dark} onUse={around.toggle} icon="M12 4a8 8 0 1 0 0 16zM12 4a8 8 0 0 1 0 16" />
      {tools}
    </>
  );
  const [one] = cast;
  if (mode === 'pose' && onPose && one) {
    return <PosingView stage={stage} cast={[one]} people={people} start={pose} tools={common} onPose={onPose} />;
  }
  if (mode === 'wall' && view) return <WallView stage={stage} cast={cast} view={view} dark={around.dark} tools={common} />;
  return <OrbitView stage={stage} cast={cast} tools={common} />;
}

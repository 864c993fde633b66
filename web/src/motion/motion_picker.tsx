/** The motions on offer: ours as drawn figures, or a file at hand. */

import { deleteMotion, type KeptMotion, listOwnMotions, renameMotion } from '../api';
import { canMove } from './motion_details';
import { SymbolCard } from '../studio/symbol_card';
import type { Motion, MotionDetails, MotionJoints, MotionName } from './types';
import { KeptList } from '../studio/kept_list';
import { useLoaded } from '../api/loading';
import { DEFAULT_MOTION, motionName } from './motion_names';
import { plain } from '../language/strings';
import { JointMappingPanel } from './joint_mapping_panel';
import { MotionDropzone } from './motion_dropzone';
import { words } from './words';
import './styles/motions.css';

/** A head at a place of the square of 48. */
const head = (x: number, y: number): string => `M${x - 4} ${y}a4 4 0 1 0 8 0a4 4 0 1 0-8 0`;

/** Figures in the middle of each motion. */
const figures: Record<MotionName, string> = {
  idle: `${head(24, 8)}M24 13v14M24 16l-6 10M24 16l6 10M24 27l-4 16M24 27l4 16`,
  walk: `${head(25, 8)}M25 13l-1 14M25 16l-6 4-2 6M25 16l5 5 5 1M24 27l6 8 2 8M24 27l-4 8-6 7`,
  run: `${head(29, 8)}M28 13l-5 13M27 16l-8 1-4 6M27 16l5 6 7-2M23 26l8 4-2 9M23 26l-5 8-9 1`,
  jump: `${head(24, 10)}M24 15v11M24 17L15 8M24 17l9-9M24 26l-8 3 3 8M24 26l8 3-3 8M14 45h20`,
  sit: `${head(18, 9)}M18 14l1 14M18 18l5 6 7 0M19 28h12v14M19 28l10 2v12M13 29v13M13 29h6`,
  wave: `${head(22, 9)}M22 14v14M22 17l-7 9M22 17l9-2 2-9M22 28l-4 15M22 28l5 15M38 4a8 8 0 0 1 1 7M42 2a13 13 0 0 1 1 10`,
  dance: `${head(22, 8)}M23 13l3 13M23 16l-9-2-4-7M23 16l9 2 6-6M26 26l-6 7 2 9M26 26l9 4 2 10`,
  bow: `${head(11, 20)}M15 20l12 3M17 21l0 9 3 5M27 23l-1 11 1 9M27 23l3 10-1 10`,
};
/** Of a motion of the user's own: the way that somebody goes. */
const way = 'M8 38c8-2 6-12 14-14s8 8 16-12M38 12l-7 1M38 12l1 7M6 38a2 2 0 1 0 4 0a2 2 0 1 0-4 0';
export const motionNames = Object.keys(figures) as MotionName[];

interface Props {
  chosen: Motion;
  onChoose: (motion: Motion) => void;
  /** The file that was chosen last is no motion: until another is chosen, none is. */
  refused: boolean;
  onRefused: () => void;
  /** Of a motion of one's own: what moves which joint otherwise than found. */
  joints: MotionJoints;
  onJoints: (joints: MotionJoints) => void;
  /** Which of its animations; null for the first in which something moves. */
  clip: string | null;
  onClip: (clip: string | null) => void;
}

/** What the list of motions says of one of them. */
export const detailsIn = (kept: readonly KeptMotion[], name: string): MotionDetails | null => {
  const { joints = [], mapping = {}, clips = [] } = kept.find((one) => one.name === name) ?? {};
  return joints.length ? { joints, mapping, clips } : null;
};

export function MotionPicker({ chosen, onChoose, refused, onRefused, joints, onJoints, clip, onClip }: Props) {
  const own = useLoaded(listOwnMotions, 'motions');
  const all = own.value ?? [];
  const kept = all.filter(canMove);
  const known = chosen.by === 'kept' ? detailsIn(kept, chosen.name) : null;
  return (
    <>
      <fieldset class="performances">
        <legend>{words.builtIn}</legend>
        <div class="cards figures">
          {motionNames.map((name) => (
            <SymbolCard
              key={name}
              value={name}
              symbol={figures[name]}
              label={motionName(name)}
              checked={!refused && chosen.by === 'name' && chosen.name === name}
              onChoose={() => onChoose({ by: 'name', name })}
            />
          ))}
        </div>
      </fieldset>
      {kept.length > 0 && (
        <fieldset class="performances">
          <legend>{words.kept}</legend>
          <div class="cards figures">
            {kept.map(({ name, title }) => (
              <SymbolCard
                key={name}
                value={`kept/${name}`}
                symbol={way}
                label={title || plain(name)}
                checked={!refused && chosen.by === 'kept' && chosen.name === name}
                onChoose={() => onChoose({ by: 'kept', name })}
              />
            ))}
          </div>
        </fieldset>
      )}
      <KeptList
        items={all.map(({ name, title, created_at }) => ({ id: created_at ?? name, name, label: title || plain(name) }))}
        rename={renameMotion}
        remove={deleteMotion}
        onRenamed={(name, now) => {
          if (chosen.by === 'kept' && chosen.name === name) {
            onChoose({ by: 'kept', name: now });
            onJoints(joints); // it is the same motion: what was said of it holds
            onClip(clip);
          }
          own.reload();
        }}
        onRemoved={(name) => {
          if (chosen.by === 'kept' && chosen.name === name) onChoose({ by: 'name', name: DEFAULT_MOTION });
          own.reload();
        }}
      />
      <h3>{words.own}</h3>
      <MotionDropzone
        file={chosen.by === 'file' ? chosen.file : null}
        onFile={(file) => onChoose({ by: 'file', file })}
        refused={refused}
        onRefused={onRefused}
      />
      {!refused && chosen.by !== 'name' && (
        <JointMappingPanel motion={chosen} known={known} value={joints} onChange={onJoints} clip={clip} onClip={onClip} />
      )}
    </>
  );
}

/** The motion of a job that is made again: as before, another of ours or one's own, or a file. */

import { useId, useState } from 'preact/hooks';
import { type Job, listOwnMotions } from '../api';
import { canMove } from './motion_details';
import type { GivenInput, MotionDetails, MotionName } from './types';
import { useLoaded } from '../api/loading';
import { isFileId, isUrl } from '../works/inputs';
import { motionName } from './motion_names';
import { plain } from '../language/strings';
import type { MotionDraft } from './draft';
import { JointMappingPanel } from './joint_mapping_panel';
import { MotionDropzone } from './motion_dropzone';
import { detailsIn, motionNames } from './motion_picker';
import { words } from './words';

/** What an error may name that is put right in the table of the motion. */
const wanted = ['motion_joints', 'motion_clip'];

interface Props {
  job: Job;
  value: MotionDraft;
  /** What the job was made with. */
  before: MotionDraft;
  onChange: (part: Partial<MotionDraft>) => void;
}

export function MotionField({ job, value: { motion: value, ...draft }, before, onChange }: Props) {
  const id = useId();
  const [refused, setRefused] = useState(false);
  const kept = (useLoaded(listOwnMotions, 'motions').value ?? []).filter(canMove);
  const held = before.motion.by === 'held' ? before.motion : null;
  const choose = (motion: MotionDraft['motion'], refused = false): void => {
    setRefused(refused);
    onChange({
      motion,
      motionJoints: motion.by === 'held' ? before.motionJoints : {},
      motionClip: motion.by === 'held' ? before.motionClip : null,
    });
  };
  const known = value.by === 'kept' ? detailsIn(kept, value.name) : value.by === 'held' ? listedIn(job) : null;
  return (
    <>
      <div class="field">
        <label for={id}>{words.motion}</label>
        <select
          id={id}
          value={value.by === 'name' || value.by === 'kept' ? `${value.by} ${value.name}` : value.by}
          onChange={({ currentTarget }) => {
            const [by, name = ''] = currentTarget.value.split(' ');
            if (by === 'held' && held) choose(held);
            else if (by === 'kept') choose({ by, name });
            else if (by === 'name') choose({ by, name: name as MotionName });
          }}
        >
          {held && <option value="held">{nameOf(held)}</option>}
          {value.by === 'file' && <option value="file">{value.file.name}</option>}
          {motionNames.map((name) => (
            <option key={name} value={`name ${name}`}>
              {motionName(name)}
            </option>
          ))}
          {kept.length > 0 && (
            <optgroup label={words.kept}>
              {kept.map(({ name, title }) => (
                <option key={name} value={`kept ${name}`}>
                  {title || plain(name)}
                </option>
              ))}
            </optgroup>
          )}
        </select>
      </div>
      <MotionDropzone
        file={value.by === 'file' ? value.file : null}
        onFile={(file) => choose({ by: 'file', file })}
        refused={refused}
        onRefused={() => choose(before.motion, true)}
      />
      {value.by !== 'name' && (
        <JointMappingPanel
          motion={value}
          known={known}
          wanted={value.by === 'held' && wanted.some((name) => job.error?.correctable?.includes(name))}
          value={draft.motionJoints}
          onChange={(motionJoints) => onChange({ motionJoints })}
          clip={draft.motionClip}
          onClip={(motionClip) => onChange({ motionClip })}
        />
      )}
    </>
  );
}

const nameOf = ({ input }: GivenInput): string =>
  isUrl(input) || isFileId(input) ? words.held : plain(input);

/** What the error of a job that could not map its motion lists; what was said by hand is among it, so that it tells nothing then. */
function listedIn(job: Job): MotionDetails | null {
  const { joints, mapping } = (job.error?.found ?? {}) as { joints?: string[]; mapping?: Record<string, string> };
  const said = Object.keys((job.options.motion_joints as object | undefined) ?? {}).length > 0;
  return joints && mapping && !said ? { joints: joints.map((name) => ({ name })), mapping } : null;
}

/** The motion of a character that is made again: as before, another of ours or one's own, or a file. */

import { useId, useState } from 'preact/hooks';
import { type Job, listOwnMotions } from '../../../api';
import { canMove } from './motion_details';
import type { MotionDetails, MotionJoints, MotionName } from '../types';
import { useLoaded } from '../../../api/loading';
import { isFileId, isUrl } from '../../../works/inputs';
import { motionName } from './motion_names';
import { plain } from '../../../language/strings';
import { type GivenInput, type RevisionDraft, draftOf } from '../corrections/changes';
import { JointMappingPanel } from './joint_mapping_panel';
import { MotionDropzone } from './motion_dropzone';
import { detailsIn, motionNames } from './motion_picker';
import { words as characterWords } from '../words';

const words = characterWords.character;
/** What an error may name that is put right in the table of the motion. */
const wanted = ['motion_joints', 'motion_clip'];

interface Props {
  job: Job;
  value: RevisionDraft['motion'];
  /** What the job moved by before. */
  before: RevisionDraft['motion'];
  joints: MotionJoints;
  clip: RevisionDraft['motionClip'];
  onChange: (draft: Partial<RevisionDraft>) => void;
}

export function MotionField({ job, value, before, joints, clip, onChange }: Props) {
  const id = useId();
  const [refused, setRefused] = useState(false);
  const kept = (useLoaded(listOwnMotions, 'motions').value ?? []).filter(canMove);
  const held = before.by === 'held' ? before : null;
  const made = draftOf(job);
  const choose = (motion: RevisionDraft['motion'], refused = false): void => {
    setRefused(refused);
    onChange({
      motion,
      motionJoints: motion.by === 'held' ? made.motionJoints : {},
      motionClip: motion.by === 'held' ? made.motionClip : null,
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
            <optgroup label={words.keptMotions}>
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
        onRefused={() => choose(before, true)}
      />
      {value.by !== 'name' && (
        <JointMappingPanel
          motion={value}
          known={known}
          wanted={value.by === 'held' && wanted.some((name) => job.error?.correctable?.includes(name))}
          value={joints}
          onChange={(motionJoints) => onChange({ motionJoints })}
          clip={clip}
          onClip={(motionClip) => onChange({ motionClip })}
        />
      )}
    </>
  );
}

const nameOf = ({ input }: GivenInput): string =>
  isUrl(input) || isFileId(input) ? words.heldMotion : plain(input);

/** What the error of a job that could not map its motion lists; what was said by hand is among it, so that it tells nothing then. */
function listedIn(job: Job): MotionDetails | null {
  const { joints, mapping } = (job.error?.found ?? {}) as { joints?: string[]; mapping?: Record<string, string> };
  const said = Object.keys((job.options.motion_joints as object | undefined) ?? {}).length > 0;
  return joints && mapping && !said ? { joints: joints.map((name) => ({ name })), mapping } : null;
}

/** Which animation of a motion's file, and which of its joints moves which of the character's; folded away. */

import { useEffect, useId, useState } from 'preact/hooks';
import type { MotionDetails, MotionJoints } from './types';
import { ProblemAlert } from '../widgets/problem_alert';
import { useLoaded } from '../api/loading';
import { strings } from '../language/strings';
import { detailsOf, keyOf, type OwnMotion } from './motion_details';
import { commonPrefix, type Group, groups, jointName, missing, moved, moverOf, required } from './joint_mapping';
import { words as motionWords } from './words';
import './styles/joint_mapping.css';

const words = motionWords.joints;
const inHands: readonly Group[] = ['leftFingers', 'rightFingers'];
const names = Object.keys(groups) as Group[];

interface Props {
  motion: OwnMotion;
  /** What is known of it without asking. */
  known?: MotionDetails | null;
  /** Whether it is what has to be put right. */
  wanted?: boolean;
  value: MotionJoints;
  onChange: (value: MotionJoints) => void;
  /** Which of its animations; null for the first in which something moves. */
  clip: string | null;
  onClip: (clip: string | null) => void;
}

/** Open from the beginning where it is wanted, or known that something is wanting. */
export function JointMappingPanel({ motion, known = null, wanted = false, ...chosen }: Props) {
  const wanting = wanted || (known !== null && missing(known.mapping, {}).length > 0);
  const [open, setOpen] = useState(wanting);
  useEffect(() => setOpen(wanting), [keyOf(motion)]);
  const changes = Object.keys(chosen.value).length + (chosen.clip === null ? 0 : 1);
  return (
    <details class="joint-mapping" open={open} onToggle={({ currentTarget }) => setOpen(currentTarget.open)}>
      <summary>
        {words.title} {changes > 0 && <span class="chip">{words.changed(changes)}</span>}
      </summary>
      {open && <Look key={keyOf(motion)} motion={motion} known={known} {...chosen} />}
    </details>
  );
}

function Look({ motion, known, ...chosen }: Omit<Props, 'wanted'>) {
  const { value: details, problem, reload } = useLoaded(
    async (signal) => known ?? detailsOf(motion, signal),
    keyOf(motion),
  );
  if (problem) {
    return (
      <ProblemAlert code={problem.code} detail={problem.detail}>
        <button type="button" class="button" onClick={reload}>
          {strings.retry}
        </button>
      </ProblemAlert>
    );
  }
  if (!details) {
    return (
      <p class="hint" role="status" aria-busy="true">
        {words.looking}
      </p>
    );
  }
  return <Table details={details} {...chosen} />;
}

interface TableProps extends Pick<Props, 'value' | 'onChange' | 'clip' | 'onClip'> {
  details: MotionDetails;
}

function Table({ details: { joints, mapping, clips = [] }, value, onChange, clip, onClip }: TableProps) {
  const clipId = useId();
  const [fingers, setFingers] = useState(false);
  const wanting = missing(mapping, value);
  const prefix = commonPrefix(joints.map(({ name }) => name));
  const group = (name: Group) => (
    <fieldset key={name}>
      <legend>{words.groups[name]}</legend>
      {groups[name].map((joint) => (
        <Row
          key={joint}
          joint={joint}
          offered={joints}
          prefix={prefix}
          mover={moverOf(joint, mapping, value)}
          changed={value[joint] !== undefined}
          onChange={(mover) => onChange(moved(joint, mover, mapping, value))}
        />
      ))}
    </fieldset>
  );
  return (
    <div class="joint-mapping-body">
      {clips.length > 1 && (
        <div class="field">
          <label for={clipId}>{words.clip}</label>
          <select
            id={clipId}
            // the empty name is no animation's
            value={clip ?? ''}
            onChange={({ currentTarget }) => onClip(currentTarget.value || null)}
          >
            <option value="">{words.firstClip}</option>
            {clips.map((name) => (
              <option key={name} value={name}>
                {name}
              </option>
            ))}
          </select>
        </div>
      )}
      <p class="hint">{words.hint}</p>
      <p class={wanting.length ? 'wanting' : 'visually-hidden'} role="status">
        {wanting.length ? words.wanting(wanting.map(jointName).join(', ')) : ''}
      </p>
      <div class="joint-mapping-groups">{names.filter((name) => !inHands.includes(name)).map(group)}</div>
      <details class="joint-mapping" open={fingers} onToggle={({ currentTarget }) => setFingers(currentTarget.open)}>
        <summary>{words.hands}</summary>
        {fingers && <div class="joint-mapping-groups">{inHands.map(group)}</div>}
      </details>
      {Object.keys(value).length > 0 && (
        <div class="actions">
          <button type="button" class="button quiet" onClick={() => onChange({})}>
            {words.asFound}
          </button>
        </div>
      )}
    </div>
  );
}

interface RowProps {
  joint: string;
  offered: MotionDetails['joints'];
  /** Of all names that are offered; not shown. */
  prefix: string;
  mover: string | null;
  changed: boolean;
  onChange: (mover: string | null) => void;
}

function Row({ joint, offered, prefix, mover, changed, onChange }: RowProps) {
  const id = useId();
  const wanting = mover === null && required.includes(joint);
  return (
    <div class={`joint-mapping-row ${changed ? 'changed' : ''} ${wanting ? 'wanting' : ''}`}>
      <label for={id}>{jointName(joint)}</label>
      <select
        id={id}
        aria-invalid={wanting}
        // the empty name is no joint's
        value={mover ?? ''}
        onChange={({ currentTarget }) => onChange(currentTarget.value || null)}
      >
        <option value="">{words.nothing}</option>
        {offered.map(({ name }) => (
          <option key={name} value={name}>
            {name.slice(prefix.length)}
          </option>
        ))}
      </select>
    </div>
  );
}

/** The motion of a character that is made again: as before, another of ours, or a file. */

import { useId } from 'preact/hooks';
import type { MotionName } from '../api';
import { Dropzone } from '../components/dropzone';
import { isMotion, motionTypes } from '../media';
import { motionName } from '../names';
import { strings } from '../strings';
import type { Wishes } from './changes';
import { motionNames } from './motions';

const words = strings.character;

interface Props {
  value: Wishes['motion'];
  /** Whether the job moved by a file. */
  held: boolean;
  onChange: (motion: Wishes['motion']) => void;
}

export function MotionField({ value, held, onChange }: Props) {
  const id = useId();
  return (
    <>
      <div class="field">
        <label for={id}>{words.motion}</label>
        <select
          id={id}
          value={value.by === 'name' ? value.name : value.by}
          onChange={({ currentTarget }) =>
            onChange(
              currentTarget.value === 'held' ? { by: 'held' } : { by: 'name', name: currentTarget.value as MotionName },
            )
          }
        >
          {held && <option value="held">{words.heldMotion}</option>}
          {value.by === 'file' && <option value="file">{value.file.name}</option>}
          {motionNames.map((name) => (
            <option key={name} value={name}>
              {motionName(name)}
            </option>
          ))}
        </select>
      </div>
      <Dropzone
        media="motion"
        file={value.by === 'file' ? value.file : null}
        accept={motionTypes}
        accepts={isMotion}
        words={{
          drop: words.motionDrop,
          browse: words.motionBrowse,
          chosen: words.motionChosen,
          wrong: words.wrongMotion,
        }}
        onFile={(file) => onChange({ by: 'file', file })}
      />
    </>
  );
}

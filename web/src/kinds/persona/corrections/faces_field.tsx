/** The faces that were found: each is used or left out at a click. */

import { FaceButtons } from '../faces/face_buttons';
import { groupsOf } from '../faces/face_groups';
import { groupTitle } from '../faces/face_list';
import type { Faces } from '../faces/use_faces';
import { MIN_PHOTOS } from '../types';
import { words as personaWords } from '../words';
import { isUsed, type RevisionDraft, toggled } from './changes';

const words = personaWords.correct;

interface Props {
  faces: Faces;
  before: RevisionDraft;
  value: RevisionDraft;
  onChange: (decisions: Pick<RevisionDraft, 'keep' | 'leaveOut'>) => void;
}

export const usedCount = ({ sheet }: Faces, before: RevisionDraft, now: RevisionDraft): number =>
  sheet.faces.filter((face, number) => isUsed(number, face, before, now)).length;

export function FacesField({ faces, before, value, onChange }: Props) {
  const { sheet } = faces;
  const decided = value.keep.length + value.leaveOut.length;
  const used = usedCount(faces, before, value);
  return (
    <section class="panel whole faces-field" aria-label={words.faces}>
      <h3>{words.faces}</h3>
      <p class="hint">{words.facesHint}</p>
      {groupsOf(sheet).map(({ reason, faces: numbers }) => (
        <div key={reason} class="face-group">
          <h4>{groupTitle(reason, numbers.length)}</h4>
          <FaceButtons
            faces={faces}
            label={groupTitle(reason, numbers.length)}
            numbers={numbers}
            isPressed={(number) => isUsed(number, sheet.faces[number]!, before, value)}
            onChoose={(number) => onChange(toggled(number, sheet.faces[number]!, before, value))}
          />
        </div>
      ))}
      <div class="actions">
        <p class="hint" role="status">
          {[words.count(used), used < MIN_PHOTOS && words.tooFew(MIN_PHOTOS), decided > 0 && words.changed(decided)].filter(Boolean).join(' ')}
        </p>
        {decided > 0 && (
          <button type="button" class="button quiet" onClick={() => onChange({ keep: [], leaveOut: [] })}>
            {words.facesBack}
          </button>
        )}
      </div>
    </section>
  );
}

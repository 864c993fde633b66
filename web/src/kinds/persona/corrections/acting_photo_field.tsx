/** Which photo the person is shown in, of those whose faces are used. */

import { FaceButtons } from '../faces/face_buttons';
import type { Faces } from '../faces/use_faces';
import { words as personaWords } from '../words';

const words = personaWords.correct;

interface Props {
  faces: Faces;
  isUsed: (number: number) => boolean;
  /** A face's number; null: the best one. */
  value: number | null;
  onChange: (photo: number | null) => void;
}

export function ActingPhotoField({ faces, isUsed, value, onChange }: Props) {
  const used = faces.sheet.faces.flatMap((_face, number) => (isUsed(number) ? [number] : []));
  return (
    <div class="field acting-photo">
      <h4>{words.actingPhoto}</h4>
      <p class="hint" role="status">
        {value === null ? words.actingPhotoBest : words.actingPhotoOf(faces.sheet.faces[value]?.photo ?? '')}
      </p>
      <FaceButtons
        faces={faces}
        label={words.actingPhoto}
        numbers={used}
        isPressed={(number) => number === value}
        onChoose={(number) => onChange(number === value ? null : number)}
      />
    </div>
  );
}

/** Which photos are shown in the light that all have in the mean. */

import { FaceButtons } from '../faces/face_buttons';
import type { Faces } from '../faces/use_faces';
import { words as personaWords } from '../words';

const words = personaWords.correct;
/** As many as the service takes. */
const MAX_PHOTOS = 64;

interface Props {
  faces: Faces;
  isUsed: (number: number) => boolean;
  /** Faces' numbers. */
  value: readonly number[];
  onChange: (photos: readonly number[]) => void;
}

export function AverageLightField({ faces, isUsed, value, onChange }: Props) {
  const used = faces.sheet.faces.flatMap((_face, number) => (isUsed(number) ? [number] : []));
  const toggled = (number: number): readonly number[] =>
    value.includes(number) ? value.filter((one) => one !== number) : [...value, number].sort((one, other) => one - other).slice(0, MAX_PHOTOS);
  return (
    <div class="field acting-photo">
      <h4>{words.averageLight}</h4>
      <p class="hint" role="status">
        {words.averageLightOf(value.length)}
      </p>
      <FaceButtons
        faces={faces}
        label={words.averageLight}
        numbers={used}
        isPressed={(number) => value.includes(number)}
        onChoose={(number) => onChange(toggled(number))}
      />
    </div>
  );
}

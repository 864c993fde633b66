/** Whom a collection is to be of, where it shows several people: by one of their faces. */

import { FaceButtons } from '../faces/face_buttons';
import type { Faces } from '../faces/use_faces';
import { words as personaWords } from '../words';

const words = personaWords.correct;

interface Props {
  faces: Faces;
  /** Faces of the people who are shown about as often; none where it was clear. */
  examples: readonly number[];
  value: number | null;
  onChange: (example: number | null) => void;
}

export function PersonField({ faces, examples, value, onChange }: Props) {
  const all = faces.sheet.faces.map((_face, number) => number);
  const asked = examples.length > 0;
  const choice = (numbers: readonly number[], label: string) => (
    <FaceButtons
      faces={faces}
      label={label}
      numbers={numbers}
      isPressed={(number) => number === value}
      onChoose={(number) => onChange(number === value ? null : number)}
    />
  );
  return (
    <section class="panel whole person-field" aria-label={words.person}>
      {asked && (
        <>
          <h3>{words.person}</h3>
          <p class="hint">{words.personHint}</p>
          <div class="examples">{choice(examples, words.person)}</div>
        </>
      )}
      <details class="choices">
        <summary>{asked ? words.anotherFace : words.otherPerson}</summary>
        <p class="hint">{words.otherPersonHint}</p>
        {choice(all, words.person)}
      </details>
      <p class="hint" role="status">
        {value !== null && words.personOf(faces.sheet.faces[value]?.photo ?? '')}
      </p>
    </section>
  );
}

/** The picture with who was found in it: one is chosen by a click, or all of them. */

import type { Frame } from '../../../api';
import { BoxedPicture, type SizedPicture } from '../../../widgets/boxed_picture';
import { SkeletonDrawing } from '../joints/skeleton_drawing';
import { isDetail, type Joints } from '../joints/skeleton';
import { words as characterWords } from '../words';

const words = characterWords.correct;

interface Props {
  picture: SizedPicture;
  people: readonly Frame[];
  /** Null where nobody is yet, or a box stands for them. */
  chosen: number | 'all' | null;
  /** Drawn by hand. */
  box: Frame | null;
  joints: Joints | null;
  onChoose: (person: number | 'all') => void;
}

export function People({ picture, people, chosen, box, joints, onChoose }: Props) {
  const several = people.length > 1;
  return (
    <>
      <BoxedPicture
        picture={picture}
        boxes={people}
        isChosen={(person) => chosen === 'all' || person === chosen}
        nameOf={(person) => words.personNumber(person + 1, people.length)}
        onChoose={onChoose}
      >
        {joints && <SkeletonDrawing joints={joints} shown={Object.keys(joints).filter((name) => !isDetail(name))} />}
        {box && <path class="framed" d={`M${box[0]} ${box[1]}h${box[2]}v${box[3]}h${-box[2]}z`} />}
      </BoxedPicture>
      {several && (
        <div class="actions">
          <p class="hint">{words.peopleHint(people.length)}</p>
          <button
            type="button"
            class="toggle"
            aria-pressed={chosen === 'all'}
            onClick={() => onChoose(chosen === 'all' ? 0 : 'all')}
          >
            {words.everybody}
          </button>
        </div>
      )}
    </>
  );
}

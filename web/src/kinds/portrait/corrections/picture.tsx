/** The portrait with what was found in it; where it shows several faces, one is chosen by a click. */

import type { PortraitReport } from '../types';
import { BoxedPicture, type SizedPicture } from '../../../widgets/boxed_picture';
import { lines, type Points } from '../landmarks/scheme';
import { words as portraitWords } from '../words';

const words = portraitWords.corrections;

interface Props {
  picture: SizedPicture;
  faces: PortraitReport['inputs']['faces'];
  chosen: number;
  landmarks: Points | null;
  onChoose: (face: number) => void;
}

export function FaceChoice({ picture, faces, chosen, landmarks, onChoose }: Props) {
  return (
    <BoxedPicture
      picture={picture}
      boxes={faces}
      isChosen={(face) => face === chosen}
      nameOf={(face) => words.face(face + 1, faces.length)}
      onChoose={onChoose}
    >
      {landmarks &&
        lines.map(({ from, to, closed }) => (
          <path
            key={from}
            d={`M${landmarks.slice(from, to).map(([x, y]) => `${x} ${y}`).join('L')}${closed ? 'Z' : ''}`}
          />
        ))}
    </BoxedPicture>
  );
}

/** Faces of which each is chosen or not by a click. The keyboard has one stop for all of them: arrow keys go from face to face. */

import { useRef, useState } from 'preact/hooks';
import { cellStyle } from '../../../widgets/sheet_cell';
import { picturesOf } from '../types';
import { words as personaWords } from '../words';
import type { Faces } from './use_faces';
import '../styles/faces.css';

const words = personaWords.faces;

interface Props {
  faces: Faces;
  label: string;
  numbers: readonly number[];
  isPressed: (number: number) => boolean;
  onChoose: (number: number) => void;
}

export function FaceButtons({ faces: { sheet, url }, label, numbers, isPressed, onChoose }: Props) {
  const [stop, setStop] = useState(0);
  const row = useRef<HTMLDivElement>(null);
  const pictures = picturesOf(sheet);
  const move = (event: KeyboardEvent): void => {
    const buttons = [...(row.current?.querySelectorAll('button') ?? [])];
    const place = nextPlace(event.key, buttons.indexOf(event.target as HTMLButtonElement), buttons.length);
    if (place === null) return;
    event.preventDefault();
    setStop(place);
    buttons[place]?.focus();
  };
  return (
    <div ref={row} class="face-cells" role="toolbar" aria-label={label} onKeyDown={move}>
      {numbers.map((number, place) => {
        const photo = sheet.faces[number]?.photo ?? '';
        return (
          <button
            key={number}
            type="button"
            tabIndex={place === Math.min(stop, numbers.length - 1) ? 0 : -1}
            aria-pressed={isPressed(number)}
            aria-label={words.face(photo)}
            title={photo}
            style={cellStyle(pictures, url, number)}
            onFocus={() => setStop(place)}
            onClick={() => onChoose(number)}
          />
        );
      })}
    </div>
  );
}

/** Where a key leads from a place among so many; null where it leads nowhere. */
export function nextPlace(key: string, place: number, count: number): number | null {
  const places: Record<string, number> = {
    ...{ ArrowRight: place + 1, ArrowDown: place + 1, ArrowLeft: place - 1, ArrowUp: place - 1 },
    ...{ Home: 0, End: count - 1 },
  };
  const wanted = places[key];
  return wanted === undefined || wanted < 0 || wanted >= count ? null : wanted;
}

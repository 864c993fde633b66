/** The portrait as it was sent, with what was found in it; where it shows several faces, one is chosen by a click. */

import { useEffect, useState } from 'preact/hooks';
import { type Job, portraitOptions, type Report } from '../../../api';
import { BoxedPicture, type Shown } from '../../../widgets/boxed_picture';
import { lines, type Points } from '../landmarks/scheme';
import { pictureUrl } from '../../../names';
import { strings } from '../../../strings';

const words = strings.redo;

/**
 * A picture to work on: the portrait itself, or, where this browser cannot show it (HEIC), the preview in its place.
 * Null while it is loaded; false where there is nothing to show.
 */
export function usePicture(job: Job, original: readonly [number, number] | null): Shown | false | null {
  const [shown, setShown] = useState<Shown | false | null>(null);
  useEffect(() => {
    let current = true;
    const options = portraitOptions(job);
    const preview = (options.crop ?? 'none') === 'none' ? job.artifacts['preview.jpg']?.url : undefined;
    const sent = pictureUrl(job);
    const show = (url: string, instead: () => void): void => {
      const image = new Image();
      image.onload = () => current && setShown({ url, size: original ?? [image.naturalWidth, image.naturalHeight] });
      image.onerror = () => current && instead();
      image.src = url;
    };
    const nothing = (): void => setShown(false);
    const usePreview = (): void => (preview && original ? show(preview, nothing) : nothing());
    if (sent) show(sent, usePreview);
    else usePreview();
    return () => {
      current = false;
    };
  }, [job.id, original?.[0], original?.[1]]);
  return shown;
}

interface Props {
  picture: Shown;
  faces: Report['inputs']['faces'];
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

/** A picture with boxes on it, one of which is chosen by a click where there are several. */

import type { ComponentChildren } from 'preact';
import type { Frame } from '../api';
import { strings } from '../language/strings';

/** A picture to work on. */
export interface SizedPicture {
  url: string;
  /** Width and height in the pixels that points and boxes are counted in. */
  size: readonly [number, number];
}

interface Props {
  picture: SizedPicture;
  boxes: readonly Frame[];
  isChosen: (index: number) => boolean;
  nameOf: (index: number) => string;
  onChoose: (index: number) => void;
  /** Drawn over the picture, in its pixels. */
  children?: ComponentChildren;
}

export function BoxedPicture({ picture, boxes, isChosen, nameOf, onChoose, children }: Props) {
  const [width, height] = picture.size;
  const share = (value: number, of: number): string => `${(value / of) * 100}%`;
  return (
    <div class="boxed" style={{ aspectRatio: `${width} / ${height}`, '--aspect': width / height }}>
      <img src={picture.url} alt={strings.job.sentAlt} />
      {children && (
        <svg viewBox={`-0.5 -0.5 ${width} ${height}`} aria-hidden="true">
          {children}
        </svg>
      )}
      {boxes.length > 1 &&
        boxes.map(([x, y, w, h], index) => (
          <button
            key={index}
            type="button"
            aria-pressed={isChosen(index)}
            aria-label={nameOf(index)}
            style={{
              left: share(x, width),
              top: share(y, height),
              width: share(w, width),
              height: share(h, height),
            }}
            onClick={() => onChoose(index)}
          />
        ))}
    </div>
  );
}

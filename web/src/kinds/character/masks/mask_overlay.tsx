/** The picture with what was found of the person over it, and with strokes over that. */

import { useId } from 'preact/hooks';
import { type LabelStroke, type MaskStroke, outline, partColours } from './strokes';

interface Props {
  url: string;
  size: readonly [width: number, height: number];
  /** What is coloured: what is not the person, the parts of the body, or nothing. */
  what: 'mask' | 'labels' | null;
  /** Pictures of what was found; without a mask, all is the person. */
  mask: string | null;
  labels: string | null;
  strokes: { mask: readonly MaskStroke[]; labels: readonly LabelStroke[] };
}

export function MaskOverlay({ url, size, what, mask, labels, strokes }: Props) {
  const id = useId();
  const [width, height] = size;
  const place = { x: -0.5, y: -0.5, width, height, preserveAspectRatio: 'none' };
  const area = { x: -0.5, y: -0.5, width, height };
  const person = `url(#${id})`;
  return (
    <>
      <defs>
        {/* white where the person is: strokes over what was found, the later ones over the earlier ones */}
        <mask id={id} maskUnits="userSpaceOnUse" {...area}>
          {mask === null ? <rect {...area} fill="#fff" /> : <image href={mask} {...place} />}
          {strokes.mask.map((stroke, index) => (
            <path
              key={index}
              class="stroke"
              d={outline(stroke)}
              style={{ stroke: stroke.person ? '#fff' : '#000', strokeWidth: 2 * stroke.radius }}
            />
          ))}
        </mask>
      </defs>
      <image href={url} {...place} />
      {what === 'mask' && (
        <>
          <rect class="not-person" {...area} />
          <image href={url} {...place} mask={person} />
        </>
      )}
      {what === 'labels' && (
        <g class="parts" mask={person}>
          {labels !== null && <image class="found" href={labels} {...place} />}
          {strokes.labels.map((stroke, index) => (
            <path
              key={index}
              class="stroke"
              d={outline(stroke)}
              style={{ stroke: partColours[stroke.part], strokeWidth: 2 * stroke.radius }}
            />
          ))}
        </g>
      )}
    </>
  );
}

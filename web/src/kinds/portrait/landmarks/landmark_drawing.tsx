/** The picture with the points and their lines over it, in the picture's own pixels. */

import type { Point } from '../../../picture_editor/geometry';
import { lines } from './scheme';

interface Props {
  url: string;
  width: number;
  height: number;
  points: readonly Point[];
  /** Each point's share in what moves. */
  share: readonly number[];
  /** The one point that is chosen. */
  chosen: number | null;
}

export function LandmarkDrawing({ url, width, height, points, share, chosen }: Props) {
  return (
    <>
      <image href={url} x="-0.5" y="-0.5" width={width} height={height} preserveAspectRatio="none" />
      {lines.map((line) => (
        <path key={line.from} class={share[line.from] === 1 ? 'line moving' : 'line'} d={outline(points, line)} />
      ))}
      {points.map(([x, y], index) => (
        <path
          key={index}
          class={index === chosen ? 'dot chosen' : share[index] ? 'dot moving' : 'dot'}
          d={`M${x} ${y}h0`}
        />
      ))}
    </>
  );
}

function outline(points: readonly Point[], { from, to, closed }: (typeof lines)[number]): string {
  return `M${points.slice(from, to).map(([x, y]) => `${x} ${y}`).join('L')}${closed ? 'Z' : ''}`;
}

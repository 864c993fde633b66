/** From where one sees a picture on a wall, and whoever has come out of it. */

import { MathUtils, Vector3 } from 'three';
import type { Hanging } from './hanging';
import { FRAME_WIDTH } from './room';

/** Share of the view that the picture takes at first; and all that is to be seen at last. */
const PICTURE_FILLS = 0.75;
const ALL_FILLS = 0.94;
/** Metres: more than people are tall, and than they are wide. */
const PERSON_HEIGHT = 1.9;
const PERSON_WIDTH = PERSON_HEIGHT / 2;
/** Metres from the middle of somebody who walks to the foot that is ahead. */
const STRIDE = 0.4;

/** What a camera sees: degrees from top to bottom, and its width by its height. */
export interface Lens {
  fov: number;
  aspect: number;
}

/** Looking straight at the wall. */
export interface Viewpoint {
  from: Vector3;
  at: Vector3;
}

/** As near as it goes with all of the picture in sight. */
export function pictureView(hanging: Hanging, lens: Lens): Viewpoint {
  const from = nearest(corners(hanging, 0), lens, PICTURE_FILLS);
  return { from, at: from.clone().setZ(hanging.plane) };
}

/** As near as it goes with all of the picture in sight, its frame among it, and everybody who stands before it at these places. */
export function roomView(hanging: Hanging, people: readonly Vector3[], lens: Lens): Viewpoint {
  const bodies = people.flatMap(({ x, z }) => {
    const sides = [x - PERSON_WIDTH / 2, x + PERSON_WIDTH / 2];
    return sides.flatMap((side) => [new Vector3(side, 0, z + STRIDE), new Vector3(side, PERSON_HEIGHT, z)]);
  });
  const from = nearest([...corners(hanging, FRAME_WIDTH), ...bodies], lens, ALL_FILLS);
  return { from, at: from.clone().setZ(Math.max(hanging.plane, ...people.map(({ z }) => z))) };
}

const corners = ({ left, right, top, bottom, plane }: Hanging, frame: number): Vector3[] =>
  [left - frame, right + frame].flatMap((x) => [bottom - frame, top + frame].map((y) => new Vector3(x, y, plane)));

/** The place nearest to points from where all of them are seen, looking along -z, in this share of the view. */
function nearest(points: readonly Vector3[], { fov, aspect }: Lens, share: number): Vector3 {
  const up = Math.tan(MathUtils.degToRad(fov) / 2) * share;
  // A point is in sight from (c, z) where |p - c| is at most (z - p.z) times the slope of the view's edge. The one that lies
  // outermost on one side and the one on the other hold the place between them.
  const bounds = (axis: 'x' | 'y', slope: number) => {
    const low = Math.min(...points.map((point) => point[axis] - point.z * slope));
    const high = Math.max(...points.map((point) => point[axis] + point.z * slope));
    return { middle: (low + high) / 2, z: (high - low) / 2 / slope };
  };
  const [across, along] = [bounds('x', up * aspect), bounds('y', up)];
  return new Vector3(across.middle, along.middle, Math.max(across.z, along.z));
}

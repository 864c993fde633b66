/** The avatar with compressed geometry beside the plain one, in three.js with its own decoder. */

import { AnimationMixer, type SkinnedMesh, Vector3 } from 'three';
import { MeshoptDecoder } from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import type { CompressedPage } from './pages';

const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
const [plain, small] = await Promise.all(
  ['/avatar.glb', '/small.glb'].map(async (url) => {
    const { scene, animations } = await loader.loadAsync(url);
    const mesh = scene.getObjectsByProperty('isSkinnedMesh', true)[0] as SkinnedMesh;
    return { scene, mesh, animations, mixer: new AnimationMixer(scene) };
  }),
);

/** Metres that a vertex of the one is from the same of the other, at most. */
function apart(): number {
  const place = new Vector3();
  const [one, other] = [plain!, small!].map(({ scene, mesh }) => {
    scene.updateMatrixWorld(true);
    mesh.skeleton.update();
    return Array.from({ length: mesh.geometry.attributes.position!.count }, (_, index) => mesh.getVertexPosition(index, place).clone());
  }) as [Vector3[], Vector3[]];
  return one.reduce((most, vertex, index) => Math.max(most, vertex.distanceTo(other[index]!)), 0);
}

const page: CompressedPage = {
  compare: (target, clip) => {
    const both = [plain!, small!];
    const rest = apart();
    const set = (value: number): void => {
      for (const { mesh } of both) mesh.morphTargetInfluences![mesh.morphTargetDictionary![target]!] = value;
    };
    set(1);
    const opened = apart();
    set(0);
    for (const { mixer, animations } of both) {
      mixer.clipAction(animations.find(({ name }) => name === clip)!).play();
      mixer.setTime(0.5);
    }
    const waving = apart();
    const { geometry, morphTargetDictionary } = small!.mesh;
    return { triangles: geometry.index!.count / 3, targets: Object.keys(morphTargetDictionary!), rest, opened, waving };
  },
};
Object.assign(window, { page });

/** A character from its GLB: the mesh, its joints by name, its face, and its clips. */

import {
  type AnimationClip,
  AnimationMixer,
  type Group,
  type KeyframeTrack,
  type Material,
  Object3D,
  type Quaternion,
  type SkinnedMesh,
  type Texture,
  Vector3,
  VectorKeyframeTrack,
} from 'three';
import { MeshoptDecoder } from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
import { CROWN } from '../posing/handles';
import { Face } from './face';

/** Of metres, and of the numbers of quaternions: what differs by less is the same. */
const SAME = 2e-3;

/** The clip that holds the pose of the picture. */
export const PICTURED = 'pictured';
export const STEP_OUT = 'step_out';
export const IN_PLACE = '_in_place';

export class Character {
  readonly root: Group;
  /** The one with the most vertices, where there are several: the body. */
  readonly mesh: SkinnedMesh;
  readonly face: Face;
  readonly joints = new Map<string, Object3D>();
  /** Where the origin of their clips is, in the world. */
  readonly home = new Vector3();
  private readonly meshes: readonly SkinnedMesh[];
  private readonly mixer: AnimationMixer;
  private readonly rest = new Map<Object3D, { position: Vector3; quaternion: Quaternion }>();
  private shown: readonly AnimationClip[] = [];

  constructor(
    scene: Group,
    readonly clips: readonly AnimationClip[],
  ) {
    this.root = scene;
    this.meshes = scene.getObjectsByProperty('isSkinnedMesh', true) as SkinnedMesh[];
    const [mesh] = [...this.meshes].sort((one, other) => vertices(other) - vertices(one));
    if (!mesh) throw new Error('the file shows nobody');
    this.mesh = mesh;
    this.face = new Face(this.meshes, clips);
    for (const each of this.meshes) each.frustumCulled = false; // its bounds are those of the T-pose
    for (const bone of this.mesh.skeleton.bones) {
      this.joints.set(bone.name, bone);
      this.rest.set(bone, { position: bone.position.clone(), quaternion: bone.quaternion.clone() });
    }
    this.mixer = new AnimationMixer(scene);
    this.addCrown();
  }

  /** Whether there is a body, which stands somewhere; a face alone floats. */
  get stands(): boolean {
    return this.joints.has('Hips');
  }

  clip(name: string): AnimationClip | undefined {
    return this.clips.find((clip) => clip.name === name);
  }

  /** The motion's clip that stays where it is. Who comes out of no picture has none, and plays the first, their own. */
  get calm(): AnimationClip | undefined {
    const inPlace = this.clips.find(({ name }) => name.endsWith(IN_PLACE));
    return inPlace ?? (this.clip(PICTURED) && this.clip('idle')) ?? this.clips[0];
  }

  /** With the origin at home; or so that a clip begins where they stand in the picture, wherever its own beginning is. */
  settle(clip?: AnimationClip): void {
    this.root.position.copy(this.home);
    const pictured = this.clip(PICTURED);
    const [there, begin] = [pictured && rootOf(pictured)?.values, clip && rootOf(clip)?.values];
    if (there && begin) this.root.position.add(new Vector3(there[0]! - begin[0]!, 0, there[2]! - begin[2]!));
    this.root.updateMatrixWorld(true);
  }

  /** Stand as in a clip at a second of it. */
  show(clip: AnimationClip, second: number): void {
    this.blend([{ clip, second, weight: 1 }]);
  }

  /** Stand between clips. */
  blend(parts: readonly { clip: AnimationClip; second: number; weight: number }[]): void {
    if (parts.length !== this.shown.length || parts.some(({ clip }, index) => clip !== this.shown[index])) {
      this.unbend();
      this.shown = parts.map(({ clip }) => clip);
      for (const clip of this.shown) this.mixer.clipAction(clip).play();
    }
    for (const { clip, second, weight } of parts) {
      const action = this.mixer.clipAction(clip).setEffectiveWeight(weight);
      action.time = Math.min(second, clip.duration);
    }
    this.mixer.update(0);
    const [main] = [...parts].sort((one, other) => other.weight - one.weight);
    this.face.act(main?.clip ?? null, main?.second);
    this.root.updateMatrixWorld(true);
  }

  /** No clip any more: the T-pose. What a clip leaves alone is so in all of it. */
  unbend(): void {
    this.mixer.stopAllAction();
    this.shown = [];
    this.face.act(null);
    for (const [bone, { position, quaternion }] of this.rest) {
      bone.position.copy(position);
      bone.quaternion.copy(quaternion);
    }
  }

  dispose(): void {
    this.mixer.stopAllAction();
    this.mixer.uncacheRoot(this.root);
    for (const { geometry, skeleton, material } of this.meshes) {
      geometry.dispose();
      skeleton.dispose();
      for (const one of [material].flat() as (Material & { map?: Texture | null })[]) {
        one.map?.dispose();
        one.dispose();
      }
    }
  }

  private addCrown(): void {
    const head = this.joints.get('Head');
    if (!head) return;
    this.root.updateMatrixWorld(true);
    this.mesh.geometry.computeBoundingBox();
    const crown = new Object3D();
    const top = this.mesh.geometry.boundingBox?.max.y ?? 0;
    crown.position.y = Math.max(0.1, top - head.matrixWorld.elements[13]);
    head.add(crown);
    this.joints.set(CROWN, crown);
  }
}

const vertices = ({ geometry }: SkinnedMesh): number => geometry.attributes.position?.count ?? 0;

/** Fetch a character; rejects where that fails or the file is none, and when it is called off. */
export async function loadCharacter(url: string, signal: AbortSignal): Promise<Character> {
  const response = await fetch(url, { signal });
  if (!response.ok) throw new Error(`${response.status}`);
  const { scene, animations } = await new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).parseAsync(await response.arrayBuffer(), '');
  const character = new Character(scene, animations);
  if (!signal.aborted) return character;
  character.dispose();
  throw new DOMException('called off', 'AbortError');
}

/** Whether a clip can be played on and on: it is made to, or moves and stands at its end as at its beginning. */
export function repeats(clip: AnimationClip): boolean {
  if (clip.userData.loops === true) return true;
  const leaves = ({ values, times }: KeyframeTrack, from: number): boolean => {
    const size = values.length / times.length;
    return values.slice(from).some((value, index) => Math.abs(value - values[index % size]!) > SAME);
  };
  const ends = (track: KeyframeTrack): number => track.values.length - track.values.length / track.times.length;
  return clip.tracks.some((track) => leaves(track, 0)) && !clip.tracks.some((track) => leaves(track, ends(track)));
}

/** The way of the hips, the one joint that goes anywhere. */
export const rootOf = (clip: AnimationClip): VectorKeyframeTrack | undefined =>
  clip.tracks.find((track) => track instanceof VectorKeyframeTrack && track.name === 'Hips.position');

/** A page with nothing but the viewer of a job's character; and the character itself, to be measured. */

import '@web/styles/tokens.css';
import '@web/styles/base.css';
import '@web/styles/controls.css';
import '@web/styles/layout.css';
import '@web/styles/studio.css';
import '@web/styles/job.css';
import type { Job } from '@web/api';
import { getSkeleton } from '@web/viewer/artifacts/skeleton';
import { KindsProvider } from '@web/kind/kinds';
import { kinds } from '@web/kinds';
import { loadCharacter } from '@web/viewer/scene/character';
import Viewer from '@web/viewer/panel';
import { hang } from '@web/viewer/wall/hanging';
import { type Degrees, turnedOn } from '@web/viewer/posing/pose';
import { Stage } from '@web/viewer/scene/stage';
import { viewOf } from '@web/viewer/artifacts/picture_view';
import { render } from 'preact';
import { Quaternion, Vector3 } from 'three';

export interface Measured {
  /** Each clip, with the farthest that a vertex and a joint go from its beginning to its middle, in metres. */
  clips: Record<string, { seconds: number; loops: boolean; vertex: number; joint: number }>;
}

declare global {
  interface Window {
    poses: Record<string, [number, number, number]>[];
    measure: () => Promise<Measured>;
    /** Where a joint is on the canvas, in pixels. */
    joint: (name: string) => [number, number];
    /** How the joints stand, as quaternions. */
    rotations: (names: string[]) => number[][];
    /** How a joint stands in the picture, turned on by some degrees. */
    turned: (name: string, degrees: Degrees) => Promise<number[]>;
    /** Where the picture is on the canvas: left, top, right and bottom; null where the job does not say. */
    picture: () => Promise<[number, number, number, number] | null>;
    /** Where the hips of everybody on the stage are, in metres of the world. */
    hips: () => [number, number, number][];
    /** Where their hips are as a clip begins. */
    begins: (clip: string) => Promise<[number, number, number]>;
    leave: () => void;
  }
}

let stage: Stage;
const draw = Stage.prototype.draw;
Stage.prototype.draw = function (this: Stage, now: number) {
  stage = this;
  draw.call(this, now);
};

const job = (await (await fetch(`/v1/jobs/${location.hash.slice(1)}`)).json()) as Job;
const page = document.getElementById('app') as HTMLElement;
window.poses = [];
const { pose } = job.options as { pose?: Record<string, [number, number, number]> };
render(
  <KindsProvider value={kinds}>
    <Viewer
      job={job}
      renew={async () => (await fetch(`/v1/jobs/${job.id}`)).json() as Promise<Job>}
      first="look"
      pose={pose}
      onPose={(pose) => window.poses.push(pose)}
    />
  </KindsProvider>,
  page,
);
window.leave = () => render(null, page);

const onCanvas = (place: Vector3): [number, number] => {
  const { clientWidth: width, clientHeight: height } = stage.renderer.domElement;
  const { x, y } = place.project(stage.camera);
  return [((x + 1) / 2) * width, ((1 - y) / 2) * height];
};
const jointOf = (name: string) => stage.scene.getObjectByName(name)!;
window.joint = (name) => onCanvas(jointOf(name).getWorldPosition(new Vector3()));
window.hips = () =>
  stage.scene.getObjectsByProperty('name', 'Hips').map((hips) => hips.getWorldPosition(new Vector3()).toArray());
window.rotations = (names) => names.map((name) => jointOf(name).quaternion.toArray());
window.turned = async (name, degrees) => {
  const character = await load();
  character.show(character.clip('pictured')!, 0);
  const pictured = character.joints.get(name)?.quaternion ?? new Quaternion();
  return turnedOn(pictured, degrees).toArray();
};
window.picture = async () => {
  const view = viewOf(job, await getSkeleton(job));
  if (!view) return null;
  const { left, top, right, bottom, plane } = hang(view.camera);
  return [...onCanvas(new Vector3(left, top, plane)), ...onCanvas(new Vector3(right, bottom, plane))];
};

const load = () => loadCharacter(job.artifacts['character.glb']?.url ?? '', new AbortController().signal);

window.begins = async (clip) => {
  const character = await load();
  character.show(character.clip(clip)!, 0);
  return character.joints.get('Hips')!.getWorldPosition(new Vector3()).toArray();
};

/** By three's own loader and mixer: where clips bring the mesh. */
window.measure = async () => {
  const character = await load();
  const { mesh, joints } = character;
  const every = 97;
  const places = () => ({
    vertices: Array.from({ length: Math.floor(mesh.geometry.attributes.position!.count / every) }, (_, index) =>
      mesh.getVertexPosition(index * every, new Vector3()),
    ),
    joints: [...joints.values()].map((joint) => joint.getWorldPosition(new Vector3())),
  });
  const farthest = (before: Vector3[], after: Vector3[]): number =>
    Math.max(...before.map((place, index) => place.distanceTo(after[index]!)));
  const clips: Measured['clips'] = {};
  for (const clip of character.clips) {
    character.show(clip, 0);
    const before = places();
    character.show(clip, clip.duration / 2);
    const after = places();
    clips[clip.name] = {
      seconds: clip.duration,
      loops: clip.userData.loops === true,
      vertex: farthest(before.vertices, after.vertices),
      joint: farthest(before.joints, after.joints),
    };
  }
  character.dispose();
  return { clips };
};

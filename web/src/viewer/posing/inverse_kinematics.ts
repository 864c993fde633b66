/** Turning bones so that a joint goes where it is wanted: one bone aims, two bend like a limb, a row of them like a spine. */

import { type Object3D, Quaternion, Vector3 } from 'three';

/** Below this sine a limb counts as straight: which way it is bent cannot be seen from it. */
const STRAIGHT = 0.05;
/** Share of its length that a limb can be stretched to: at all of it, the bend would flip. */
const MAX_EXTENSION = 0.999;
/** Rounds in which a row of bones comes close. */
const ROUNDS = 12;

export const placeOf = (joint: Object3D): Vector3 => joint.getWorldPosition(new Vector3());

/** Turn a bone by a rotation of the world about its head. */
function turn(bone: Object3D, rotation: Quaternion): void {
  const parent = bone.parent?.getWorldQuaternion(new Quaternion()) ?? new Quaternion();
  bone.quaternion.premultiply(parent.clone().invert().multiply(rotation).multiply(parent));
  bone.updateWorldMatrix(false, true);
}

/** Turn a bone the shortest way so that `tip`, a place that it carries, lies towards `target`; by a share of that. */
export function aim(bone: Object3D, tip: Vector3, target: Vector3, share = 1): void {
  const head = placeOf(bone);
  const from = tip.clone().sub(head).normalize();
  const to = target.clone().sub(head).normalize();
  turn(bone, new Quaternion().slerp(new Quaternion().setFromUnitVectors(from, to), share));
}

/**
 * Bend a limb so that its end comes to `target`, or as near as it is long; in the plane in which it is bent already.
 *
 * `hinge`: about which axis a straight limb bends, in the T-pose.
 */
export function reach(upper: Object3D, lower: Object3D, end: Object3D, target: Vector3, hinge: Vector3): void {
  const [root, middle, tip] = [upper, lower, end].map(placeOf) as [Vector3, Vector3, Vector3];
  const [first, second] = [middle.clone().sub(root), tip.clone().sub(middle)];
  const [a, b] = [first.length(), second.length()];
  const distance = Math.min(Math.max(target.distanceTo(root), Math.abs(a - b) / MAX_EXTENSION), (a + b) * MAX_EXTENSION);
  // the law of cosines gives the angle within the elbow; the bend is what it lacks of a straight one
  const bend = Math.PI - Math.acos(clamped((a * a + b * b - distance * distance) / (2 * a * b)));
  const axis = first.clone().cross(second).divideScalar(a * b);
  const bent = axis.length() > STRAIGHT;
  if (!bent) axis.copy(hinge).applyQuaternion(upper.getWorldQuaternion(new Quaternion()));
  turn(lower, new Quaternion().setFromAxisAngle(axis.normalize(), bend - (bent ? first.angleTo(second) : 0)));
  aim(upper, placeOf(end), target);
}

/** Bend a row of bones, each as much as the next, so that `tip` comes near `target`. */
export function lean(bones: readonly Object3D[], tip: Object3D, target: Vector3): void {
  for (let round = 0; round < ROUNDS; round++) {
    for (const bone of bones) aim(bone, placeOf(tip), target, 1 / bones.length);
  }
}

const clamped = (cosine: number): number => Math.min(1, Math.max(-1, cosine));

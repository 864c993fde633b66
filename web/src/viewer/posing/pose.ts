/** A pose by hand: how far joints are turned on from the pictured pose, as the option `pose` of a character says it. */

import { Euler, MathUtils, Quaternion } from 'three';

/** Degrees about x, y and z of the T-pose, in that order about axes that stay. */
export type Degrees = [x: number, y: number, z: number];
/** By the names of the skeleton's joints; a joint that is left out is as pictured. */
export type Pose = Readonly<Record<string, Degrees>>;

/** Turns about fixed x, y, z are turns about moving z, y, x. */
const ORDER = 'ZYX';
/** Degrees that are told: more digits than anybody sees. */
const STEP = 0.01;

/** The joint's rotation: the pictured one, turned on. */
export function turnedOn(pictured: Quaternion, degrees: Degrees): Quaternion {
  const [x, y, z] = degrees.map(MathUtils.degToRad) as Degrees;
  return pictured.clone().multiply(new Quaternion().setFromEuler(new Euler(x, y, z, ORDER)));
}

/** How far a rotation is turned on from the pictured one: the inverse of `turnedOn`. */
export function degreesBetween(pictured: Quaternion, rotation: Quaternion): Degrees {
  const { x, y, z } = new Euler().setFromQuaternion(pictured.clone().invert().multiply(rotation).normalize(), ORDER);
  return [x, y, z].map(MathUtils.radToDeg) as Degrees;
}

/** The pose in hundredths of a degree, without joints that are as pictured. */
export function rounded(pose: Pose): Record<string, Degrees> {
  const near = (angle: number): number => Math.round(angle / STEP) * STEP;
  const entries = Object.entries(pose).map(([joint, degrees]): [string, Degrees] => [
    joint,
    degrees.map((angle) => Number(near(angle).toFixed(2)) || 0) as Degrees,
  ]);
  return Object.fromEntries(entries.filter(([, degrees]) => degrees.some((angle) => angle !== 0)));
}

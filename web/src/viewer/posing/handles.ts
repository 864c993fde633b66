/** Which places of a character can be taken hold of, and which bones follow. */

import { type Object3D, Vector3 } from 'three';
import { aim, lean, placeOf, reach } from './inverse_kinematics';

export interface Handle {
  /** The joint that goes where it is dragged. */
  joint: string;
  /** The bones that turn for it, from the trunk outwards. */
  turns: readonly string[];
  /** About which axis a straight limb bends, in the T-pose. */
  hinge?: Vector3;
}

/** No joint of the skeleton: the crown of the head, which turns it. */
export const CROWN = 'Crown';

const sides = ['Left', 'Right'] as const;
/** Knees bend backwards, elbows forwards; in the T-pose the person looks along z, arms along x. */
const knee = new Vector3(1, 0, 0);
const elbow = { Left: new Vector3(0, -1, 0), Right: new Vector3(0, 1, 0) };

export const handles: readonly Handle[] = [
  { joint: CROWN, turns: ['Head'] },
  { joint: 'Head', turns: ['Neck'] },
  { joint: 'Neck', turns: ['Spine', 'Spine1', 'Spine2'] },
  ...sides.flatMap((side): Handle[] => [
    { joint: `${side}Arm`, turns: [`${side}Shoulder`] },
    { joint: `${side}ForeArm`, turns: [`${side}Arm`] },
    { joint: `${side}Hand`, turns: [`${side}Arm`, `${side}ForeArm`], hinge: elbow[side] },
    { joint: `${side}HandMiddle1`, turns: [`${side}Hand`] },
    { joint: `${side}Leg`, turns: [`${side}UpLeg`] },
    { joint: `${side}Foot`, turns: [`${side}UpLeg`, `${side}Leg`], hinge: knee },
    { joint: `${side}ToeBase`, turns: [`${side}Foot`] },
  ]),
];

/** The bones that can be turned by themselves, from the trunk outwards. */
export const turnable: readonly string[] = [
  'Hips',
  'Spine',
  'Spine1',
  'Spine2',
  'Neck',
  'Head',
  ...sides.flatMap((side) => ['Shoulder', 'Arm', 'ForeArm', 'Hand', 'UpLeg', 'Leg', 'Foot'].map((bone) => side + bone)),
];

/** Turn the handle's bones so that its joint goes to `target`, in the world. */
export function follow(handle: Handle, joints: ReadonlyMap<string, Object3D>, target: Vector3): void {
  const joint = joints.get(handle.joint);
  const [first, second, ...more] = handle.turns.map((name) => joints.get(name));
  if (!joint || !first) return;
  if (!second) aim(first, placeOf(joint), target);
  else if (handle.hinge) reach(first, second, joint, target, handle.hinge);
  else lean([first, second, ...more].filter((bone) => bone !== undefined), joint, target);
}

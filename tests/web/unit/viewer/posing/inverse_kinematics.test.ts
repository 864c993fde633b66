import { follow, handles } from '@web/viewer/posing/handles';
import { aim, placeOf, reach } from '@web/viewer/posing/inverse_kinematics';
import { Object3D, Quaternion, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';

const named = (name: string) => handles.find(({ joint }) => joint === name)!;

/** Joints in a row, each at an offset from the one before; the first hangs from something turned and moved. */
function chain(...offsets: [string, number, number, number][]): Map<string, Object3D> {
  const world = new Object3D();
  world.position.set(0.3, 1, -0.2);
  world.quaternion.set(0.2, 0.4, -0.1, 0.8).normalize();
  const joints = new Map<string, Object3D>();
  let parent = world;
  for (const [name, x, y, z] of offsets) {
    const joint = new Object3D();
    joint.position.set(x, y, z);
    parent.add(joint);
    joints.set(name, joint);
    parent = joint;
  }
  world.updateMatrixWorld(true);
  return joints;
}
const arm = () => chain(['LeftArm', 0, 0, 0], ['LeftForeArm', 0.3, 0, 0], ['LeftHand', 0.25, 0, 0]);
const leg = () => chain(['RightUpLeg', 0, 0, 0], ['RightLeg', 0, -0.45, 0], ['RightFoot', 0, -0.42, 0]);
const at = (joints: Map<string, Object3D>, name: string) => placeOf(joints.get(name)!);
/** A place said in the T-pose's axes of the chain. */
const from = (joints: Map<string, Object3D>, name: string, x: number, y: number, z: number) => {
  const root = joints.get(name)!;
  return new Vector3(x, y, z).applyQuaternion(root.parent!.getWorldQuaternion(new Quaternion())).add(placeOf(root));
};

describe('a bone', () => {
  it('aims at a place, and keeps its length', () => {
    const joints = arm();
    const target = from(joints, 'LeftArm', 0, 0, 5);
    aim(joints.get('LeftArm')!, at(joints, 'LeftForeArm'), target);
    expect(at(joints, 'LeftForeArm').distanceTo(from(joints, 'LeftArm', 0, 0, 0.3))).toBeLessThan(1e-9);
  });
});

describe('a limb', () => {
  it('brings its end to where it is wanted', () => {
    for (const [x, y, z] of [[0.4, 0.1, 0.1], [0, -0.3, 0.2], [-0.1, 0.2, 0.3], [0.2, 0, -0.4]] as const) {
      const joints = arm();
      joints.get('LeftForeArm')!.rotation.set(0, -0.6, 0.2); // bent, so that the plane of the bend is known
      joints.get('LeftArm')!.updateMatrixWorld(true);
      const target = from(joints, 'LeftArm', x, y, z);
      follow(named('LeftHand'), joints, target);
      expect(at(joints, 'LeftHand').distanceTo(target)).toBeLessThan(1e-9);
    }
  });

  it('bends the way that elbows and knees do', () => {
    const arms = arm();
    follow(named('LeftHand'), arms, from(arms, 'LeftArm', 0.3, 0, 0));
    // the hand comes nearer along the arm: the elbow goes back, that is, the forearm forwards
    const elbow = at(arms, 'LeftForeArm').sub(from(arms, 'LeftArm', 0, 0, 0));
    const forwards = from(arms, 'LeftArm', 0, 0, 1).sub(from(arms, 'LeftArm', 0, 0, 0));
    expect(elbow.dot(forwards)).toBeLessThan(-0.1);
    const legs = leg();
    follow(named('RightFoot'), legs, from(legs, 'RightUpLeg', 0, -0.6, 0));
    const knee = at(legs, 'RightLeg').sub(from(legs, 'RightUpLeg', 0, 0, 0));
    const ahead = from(legs, 'RightUpLeg', 0, 0, 1).sub(from(legs, 'RightUpLeg', 0, 0, 0));
    expect(knee.dot(ahead)).toBeGreaterThan(0.1);
    expect(at(legs, 'RightFoot').distanceTo(from(legs, 'RightUpLeg', 0, -0.6, 0))).toBeLessThan(1e-9);
  });

  it('is stretched towards what is too far away', () => {
    const joints = arm();
    follow(named('LeftHand'), joints, from(joints, 'LeftArm', 0, 3, 0));
    expect(at(joints, 'LeftHand').distanceTo(from(joints, 'LeftArm', 0, 0.55, 0))).toBeLessThan(2e-3);
  });

  it('folds as far as it can where it is wanted too near', () => {
    const joints = arm();
    const [upper, lower, end] = ['LeftArm', 'LeftForeArm', 'LeftHand'].map((name) => joints.get(name)!) as [Object3D, Object3D, Object3D];
    reach(upper, lower, end, from(joints, 'LeftArm', 0.001, 0, 0), new Vector3(0, -1, 0));
    expect(at(joints, 'LeftHand').distanceTo(at(joints, 'LeftArm'))).toBeCloseTo(0.05, 3);
  });
});

describe('a spine', () => {
  it('leans in all of its bones', () => {
    const joints = chain(['Spine', 0, 0, 0], ['Spine1', 0, 0.12, 0], ['Spine2', 0, 0.13, 0], ['Neck', 0, 0.19, 0]);
    const target = from(joints, 'Spine', 0.15, 0.4, 0.05);
    follow(named('Neck'), joints, target);
    expect(at(joints, 'Neck').distanceTo(target)).toBeLessThan(0.02);
    for (const name of ['Spine', 'Spine1', 'Spine2']) expect(joints.get(name)!.quaternion.w).toBeLessThan(0.9999);
  });
});

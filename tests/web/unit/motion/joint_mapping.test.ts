import { commonPrefix, groups, jointName, missing, moved, moverOf, required } from '@web/motion/joint_mapping';
import { describe, expect, it } from 'vitest';

const found = { Hips: 'pelvis', LeftArm: 'arm_l', Neck: 'neck' };

describe('what moves a joint', () => {
  it('is what was found, unless it is said otherwise', () => {
    expect(moverOf('LeftArm', found, {})).toBe('arm_l');
    expect(moverOf('LeftArm', found, { LeftArm: 'arm_l_02' })).toBe('arm_l_02');
    expect(moverOf('LeftArm', found, { LeftArm: null })).toBe(null);
    expect(moverOf('Head', found, {})).toBe(null);
  });

  it('is told only where it is not as found', () => {
    const other = moved('LeftArm', 'arm_l_02', found, { Neck: null });
    expect(other).toEqual({ LeftArm: 'arm_l_02', Neck: null });
    expect(moved('LeftArm', 'arm_l', found, other)).toEqual({ Neck: null });
    expect(moved('Neck', 'neck', found, { Neck: null })).toEqual({});
    expect(moved('Head', null, found, { Head: 'skull' })).toEqual({});
  });

  it('is wanting for joints without which nobody moves', () => {
    const whole = Object.fromEntries(required.map((joint) => [joint, joint]));
    expect(missing(whole, {})).toEqual([]);
    expect(missing(whole, { Hips: null, Neck: null })).toEqual(['Hips']);
    expect(missing({}, whole)).toEqual([]);
  });
});

describe('the joints of a character', () => {
  const all = Object.values(groups).flat();

  it('are each in one group, those that are required among them', () => {
    expect(new Set(all).size).toBe(all.length);
    for (const joint of required) expect(all).toContain(joint);
  });

  it('have each a name of their own', () => {
    const names = all.map(jointName);
    expect(new Set(names).size).toBe(all.length);
    expect([jointName('LeftToeBase'), jointName('RightHandIndex2')]).toEqual(['Left toes', 'Right index finger, 2']);
  });
});

describe('what exporters put before all names', () => {
  it('ends with a mark, and is of all of them', () => {
    expect(commonPrefix(['mixamorig:Hips', 'mixamorig:Head'])).toBe('mixamorig:');
    expect(commonPrefix(['rig|m_avg_L_Hip', 'rig|m_avg_R_Hip'])).toBe('rig|m_avg_');
    expect(commonPrefix(['LeftLeg', 'LeftFoot'])).toBe('');
    expect(commonPrefix(['mixamorig:Hips', 'Head'])).toBe('');
  });

  it('leaves something of each name', () => {
    expect(commonPrefix(['a_', 'a_b'])).toBe('');
    expect(commonPrefix([])).toBe('');
  });
});

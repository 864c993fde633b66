import { type Degrees, degreesBetween, rounded, turnedOn } from '@web/viewer/posing/pose';
import { Quaternion } from 'three';
import { describe, expect, it } from 'vitest';

const pictured = new Quaternion(0.1, -0.2, 0.3, 0.9273618495495703);

describe('a pose by hand', () => {
  // scipy: Rotation.from_quat(pictured) * Rotation.from_euler('xyz', degrees, degrees=True), as the engine does it
  it.each<[Degrees, number[]]>([
    [[30, 40, 50], [-0.0203945000281, 0.19487933327043, 0.59572884907569, 0.77891799838727]],
    [[-170, 80, 12.5], [-0.83002501562226, -0.31851979054236, 0.44035879974271, -0.12525072440218]],
  ])('of %j degrees is what the engine makes of it', (degrees, known) => {
    const { x, y, z, w } = turnedOn(pictured, degrees);
    const sign = Math.sign(w * known[3]!);
    [x, y, z, w].forEach((part, index) => expect(sign * part).toBeCloseTo(known[index]!, 12));
  });

  it('is told as it was made', () => {
    for (let x = -175; x <= 175; x += 35) {
      for (let y = -85; y <= 85; y += 17) {
        for (let z = -175; z <= 175; z += 35) {
          const told = degreesBetween(pictured, turnedOn(pictured, [x, y, z]));
          [x, y, z].forEach((angle, index) => expect(told[index]).toBeCloseTo(angle, 9));
        }
      }
    }
  });

  it('at the pole, where two angles are one turn, is the same turn', () => {
    const rotation = turnedOn(pictured, [20, 90, 50]);
    expect(turnedOn(pictured, degreesBetween(pictured, rotation)).angleTo(rotation)).toBeLessThan(1e-6);
  });

  it('leaves out what is as pictured', () => {
    expect(rounded({ Head: [0.004, 0, -0.004], Neck: [1.006, -0, 359.9999] })).toEqual({ Neck: [1.01, 0, 360] });
  });
});

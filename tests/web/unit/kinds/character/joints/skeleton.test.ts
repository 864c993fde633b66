import { jointsOf, labelOf, limbs, middleOf, needed, placedJoints, sharesOf, skeletonIn, swapped } from '@web/kinds/character/joints/skeleton';
import { describe, expect, it } from 'vitest';

describe('a skeleton', () => {
  it('has limbs whose ends are joints that can be placed', () => {
    const places = Object.fromEntries(needed.map((name) => [name, [1, 2] as const]));
    const all = new Set(limbs.flatMap(({ from, to }) => [from, to]));
    for (const name of Object.keys(places)) expect(all.has(name), name).toBe(true);
    expect([labelOf('LeftElbow'), labelOf('Nose'), labelOf('MouthRight')]).toEqual([
      ...['Left elbow', 'Nose', 'Right corner of the mouth'],
    ]);
  });

  it('to begin with stands in its frame, the left hand to the right of the picture', () => {
    for (const size of [[600, 800], [1920, 400], [90, 900]] as const) {
      const [x, y, width, height] = middleOf(size);
      const joints = skeletonIn([x, y, width, height]);
      expect(Object.keys(joints).sort()).toEqual([...needed].sort());
      for (const [px, py] of Object.values(joints)) {
        expect(px).toBeGreaterThanOrEqual(x);
        expect(px).toBeLessThanOrEqual(x + width);
        expect(py).toBeGreaterThan(y);
        expect(py).toBeLessThan(y + height);
      }
      expect(joints.LeftWrist![0]).toBeGreaterThan(joints.RightWrist![0]);
      expect(joints.LeftAnkle![1]).toBeGreaterThan(joints.LeftHip![1]);
    }
  });

  it('moves a hand with its wrist, and an arm joint by joint', () => {
    const names = ['LeftElbow', 'LeftWrist', 'LeftThumb', 'RightThumb'];
    expect(sharesOf(names, 'LeftWrist')).toEqual([0, 1, 1, 0]);
    expect(sharesOf(names, 'LeftElbow')).toEqual([1, 0, 0, 0]);
    expect(sharesOf(names, null)).toEqual([1, 1, 1, 1]);
  });

  it('swaps left and right, and back', () => {
    const joints = { LeftElbow: [1, 2], RightElbow: [3, 4], MouthLeft: [5, 6], MouthRight: [7, 8], Nose: [9, 9] } as const;
    const other = swapped(joints);
    expect([other.LeftElbow, other.MouthRight, other.Nose]).toEqual([[3, 4], [5, 6], [9, 9]]);
    expect(swapped(other)).toEqual(joints);
  });

  it('sends the joints that were moved, those that were placed before, and none that was found there', () => {
    const found = jointsOf({
      size: [100, 200],
      joints: { A: { place: [10, 10], confidence: 1 }, B: { place: [20, 20], confidence: 1 }, C: { place: [30, 30], confidence: 1 } },
    });
    const joints = { ...found, A: [11.26, 10] as const };
    expect(placedJoints(joints, found, { B: [20, 20] }, [100, 200])).toEqual({ A: [11.3, 10], B: [20, 20] });
    expect(Object.keys(placedJoints(joints, null, null, [100, 200]))).toEqual(['A', 'B', 'C']);
    expect(placedJoints({ A: [-500, 900] }, found, null, [100, 200])).toEqual({ A: [-25, 250] });
  });
});

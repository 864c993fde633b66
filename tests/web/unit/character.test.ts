import { another, changesOf, isChanged, isEverybody, notesFor, type Wishes, wishesOf } from '@web/kinds/character/changes';
import { choicesOf, optionsOf, usual } from '@web/kinds/character/choices';
import { enlarged, frameBetween, movedFrame } from '@web/kinds/character/framing';
import { jointsOf, labelOf, limbs, middleOf, needed, placedJoints, sharesOf, skeletonIn, swapped } from '@web/kinds/character/skeleton';
import { fewer, type MaskStroke, outline, simplified } from '@web/kinds/character/strokes';
import { toSegment } from '@web/stage/place';
import { describe, expect, it } from 'vitest';
import { aJob } from './job';

const of = (options: object, inputs: Record<string, string> = {}) =>
  aJob({ kind: 'character', inputs: { photo: 'x', ...inputs }, options: options as never });
const plain = wishesOf(of({}));
const after = (part: Partial<Wishes>, before = plain) => changesOf(before, { ...before, ...part }, {});

describe('the options of a character', () => {
  it('sends only what differs from the usual', () => {
    expect(optionsOf(usual)).toEqual({});
    expect(optionsOf({ ...usual, keep: ['right_arm', 'head'], back: 'inpaint', lit: true, vrm: true })).toEqual({
      ...{ keep: ['head', 'right_arm'], back_texture: 'inpaint', lit: true, vrm: true },
    });
    expect(optionsOf({ ...usual, vrm: true, author: ' Ada ' })).toEqual({ vrm: true, vrm_author: 'Ada' });
    expect(optionsOf({ ...usual, author: '  ' })).toEqual({});
    expect(optionsOf({ ...usual, size: [512, 512], rate: 24, format: 'webp', triangles: 10_000, levels: 2 })).toEqual({
      ...{ size: [512, 512], fps: 24, format: 'webp', triangles: 10_000, levels: 2 },
    });
  });

  it('shows what a job was made with, names for two parts included', () => {
    expect(choicesOf({})).toEqual(usual);
    expect(choicesOf({ keep: ['legs', 'head'], camera: 'orbit' }).keep).toEqual(['head', 'left_leg', 'right_leg']);
    expect(choicesOf({ lit: true })).toEqual({ ...usual, lit: true });
    expect(choicesOf({ size: [640, 480], fps: 12.5, format: 'png', triangles: 5000, levels: 1 })).toEqual({
      ...{ ...usual, size: [640, 480], rate: 12.5, format: 'png', triangles: 5000, levels: 1 },
    });
    expect(choicesOf({ vrm: true, vrm_author: 'Ada' })).toEqual({ ...usual, vrm: true, author: 'Ada' });
  });
});

describe('a revision', () => {
  it('asks for nothing where nothing was changed', () => {
    const made = { keep: ['arms'], seconds: 2, motion: 'dance', joints: { LeftElbow: [1, 2] }, person_index: 1 };
    const wishes = wishesOf(of(made));
    expect(changesOf(wishes, wishesOf(of(made)), {})).toEqual({ corrections: {}, options: {} });
    expect(isChanged(wishes, { ...wishes, keep: [...wishes.keep].reverse() })).toBe(false);
    const filmed = { size: [640, 480], fps: 12.5, format: 'png', triangles: 5000, levels: 1 };
    expect(isChanged(wishesOf(of(filmed)), wishesOf(of(filmed)))).toBe(false);
  });

  it('puts right what was found, and takes back what is no longer wanted', () => {
    const mask: MaskStroke[] = [{ path: [[1, 2]], radius: 3, person: true }];
    expect(after({ joints: { LeftElbow: [3, 4] }, mask }).corrections).toEqual({
      ...{ joints: { LeftElbow: [3, 4] }, mask_strokes: mask },
    });
    const painted = wishesOf(of({ mask_strokes: mask, person_box: [1, 2, 3, 4], camera: 'orbit', keep: ['head'], lit: true }));
    expect(after({ mask: [], box: null, camera: 'fixed', keep: [], lit: false }, painted)).toEqual({
      ...{ corrections: { mask_strokes: null, person_box: null }, options: { camera: null, keep: null, lit: null } },
    });
  });

  it('makes another video, or a finer character, and the usual ones again', () => {
    expect(after({ size: [1024, 1024], rate: 60, format: 'webm', triangles: 200_000, levels: 3 }).options).toEqual({
      ...{ size: [1024, 1024], fps: 60, format: 'webm', triangles: 200_000, levels: 3 },
    });
    const made = wishesOf(of({ size: [512, 512], fps: 24, format: 'webp', triangles: 10_000, levels: 2 }));
    expect(after({ size: [1920, 1920] }, made).options).toEqual({ size: [1920, 1920] });
    const { size, rate, format, triangles, levels } = usual;
    expect(after({ size, rate, format, triangles, levels }, made).options).toEqual({
      ...{ size: null, fps: null, format: null, triangles: null, levels: null },
    });
  });

  it('moves by another clip, or by a file; the file that a clip replaces is named', () => {
    expect(after({ motion: { by: 'name', name: 'bow' } })).toEqual({ corrections: {}, options: { motion: 'bow' } });
    const file = new File(['x'], 'a.bvh');
    expect(changesOf(plain, { ...plain, motion: { by: 'file', file } }, { motion: 'id' }).corrections).toEqual({ motion: 'id' });
    const moved = wishesOf(of({}, { motion: '0198c1d2-7b1a-7c3e-9c6d-000000000002' }));
    expect(moved.motion).toEqual({ by: 'held', input: '0198c1d2-7b1a-7c3e-9c6d-000000000002' });
    expect(after({ motion: { by: 'name', name: 'walk' } }, moved)).toEqual({
      ...{ corrections: { motion: null }, options: { motion: 'walk' } },
    });
  });

  it('moves by a kept motion, whose joints are told only where they are not as found', () => {
    const kept = { motion: { by: 'kept', name: 'kick' }, motionJoints: { LeftArm: 'arm_l', Neck: null } } as const;
    expect(after(kept).corrections).toEqual({ motion: 'kick', motion_joints: { LeftArm: 'arm_l', Neck: null } });
    const made = wishesOf(of({ motion_joints: { LeftArm: 'arm_l' } }, { motion: 'kick' }));
    expect(changesOf(made, made, {}).corrections).toEqual({});
    expect(after({ motion: { by: 'name', name: 'bow' }, motionJoints: {} }, made).corrections).toEqual({
      ...{ motion: null, motion_joints: null },
    });
    expect(notesFor(of({}), { ...plain, ...kept }).metadata).toEqual({ motion: 'Kick' });
    expect(notesFor(of({}), plain)).toEqual({});
  });

  it('plays another animation of the motion, or the first again', () => {
    const made = wishesOf(of({ motion_clip: 'Run' }, { motion: 'kick' }));
    expect(changesOf(made, made, {}).corrections).toEqual({});
    expect(after({ motionClip: 'Jump' }, made).corrections).toEqual({ motion_clip: 'Jump' });
    expect(after({ motionClip: null }, made).corrections).toEqual({ motion_clip: null });
    const jig = { motion: { by: 'kept', name: 'jig' }, motionClip: null } as const;
    expect(after(jig, made).corrections).toEqual({ motion: 'jig', motion_clip: null });
  });

  it('gives files in place of what was found, and takes them back', () => {
    const maskFile = new File(['x'], 'mask.png');
    expect(isChanged(plain, { ...plain, maskFile })).toBe(true);
    expect(changesOf(plain, { ...plain, maskFile }, { mask: 'id' }).corrections).toEqual({ mask: 'id' });
    const made = wishesOf(of({}, { mask: 'm', labels: 'l' }));
    expect(isChanged(made, wishesOf(of({}, { mask: 'm', labels: 'l' })))).toBe(false);
    expect(after({ maskFile: null }, made).corrections).toEqual({ mask: null });
    expect(after(another({ person: 1 }), made).corrections).toEqual({ person_index: 1, mask: null, labels: null });
  });

  it('says who is meant where that was asked, the largest too', () => {
    const crowd = aJob({ kind: 'character', status: 'failed', error: { code: 'crowd', detail: 'Choose one.' } });
    expect(after(another({ person: 0 }), wishesOf(crowd)).corrections).toEqual({ person_index: 0 });
    expect(after(another({ person: 0 }), wishesOf(of({}))).corrections).toEqual({});
    expect(after(another({ person: 0 }), wishesOf(of({ person_index: 1 }))).corrections).toEqual({ person_index: 0 });
  });

  it('of somebody else forgets what was put right of the one before', () => {
    const made = wishesOf(of({ joints: { LeftElbow: [1, 2] }, person_box: [1, 2, 3, 4], pose: { LeftArm: [0, 0, 9] } }));
    expect(after(another({ person: 'all' }), made)).toEqual({
      corrections: { person_index: 'all', person_box: null, joints: null },
      options: { pose: null },
    });
    expect(after(another({ box: [5, 6, 7, 8] }), made).corrections).toEqual({ person_box: [5, 6, 7, 8], joints: null });
  });

  it('of a box that is taken away is of whoever was chosen before it was drawn', () => {
    const boxed = (wishes: Wishes): Wishes => ({ ...wishes, ...another({ box: [5, 6, 7, 8] }) });
    const second = wishesOf(of({ person_index: 1 }));
    expect(changesOf(second, boxed(second), {}).corrections).toEqual({ person_box: [5, 6, 7, 8] });
    const made = wishesOf(of({ person_index: 1, person_box: [5, 6, 7, 8] }));
    expect(after(another({ box: null }), made).corrections).toEqual({ person_box: null });
    for (const person of [0, 1, 'all', null] as const) {
      const before = { ...plain, person };
      expect({ ...boxed(before), ...another({ box: null }) }).toEqual(before);
    }
  });

  it('of a box is of one person, whoever was chosen', () => {
    const everybody = wishesOf(of({ person_index: 'all' }));
    expect(isEverybody(everybody)).toBe(true);
    expect(isEverybody({ ...everybody, box: [5, 6, 7, 8] })).toBe(false);
    expect(after(another({ box: [5, 6, 7, 8] }), everybody).corrections).toEqual({ person_index: 0, person_box: [5, 6, 7, 8] });
  });
});

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

describe('a stroke', () => {
  const wave = Array.from({ length: 200 }, (_, i) => [i, 20 * Math.sin(i / 20)] as const);

  it('is sent with fewer places, from which what was drawn is never far', () => {
    const kept = fewer(wave, 1);
    expect(kept.length).toBeLessThan(40);
    expect([kept[0], kept.at(-1)]).toEqual([wave[0], wave.at(-1)]);
    for (const place of wave) {
      const nearest = Math.min(...kept.slice(1).map((end, index) => toSegment(place, kept[index]!, end)));
      expect(nearest).toBeLessThanOrEqual(1 + 1e-9);
    }
  });

  it('keeps what says what it covers, in tenths of a pixel', () => {
    expect(simplified({ path: [[1.234, 5.678]], radius: 4.44, person: false })).toEqual({
      ...{ path: [[1.2, 5.7]], radius: 4.4, person: false },
    });
    const there = simplified({ path: [[0, 0], [5, 0.1], [10, 0]], radius: 8, part: 'head' as const });
    expect([there.path, there.part]).toEqual([[[0, 0], [10, 0]], 'head']);
  });

  it('that comes back to where it began keeps its way', () => {
    expect(fewer([[0, 0], [10, 0], [10, 10], [0, 0]], 0.5)).toEqual([[0, 0], [10, 0], [10, 10], [0, 0]]);
  });

  it('is drawn as a line, or as a dab', () => {
    expect(outline({ path: [[1, 2]], radius: 1 })).toBe('M1 2h0');
    expect(outline({ path: [[1, 2], [3, 4]], radius: 1 })).toBe('M1 2L3 4');
  });
});

describe('a frame', () => {
  const size = [100, 200] as const;

  it('lies between two corners, within the picture, whichever way it is drawn', () => {
    expect(frameBetween([60, 150], [20, -50], size)).toEqual([20, 0, 40, 150]);
    expect(frameBetween([100, 200], [100, 200], size)).toEqual([92, 192, 8, 8]);
  });

  it('keeps its size where it is moved, and its middle where it is made larger', () => {
    expect(movedFrame([80, 10, 20, 20], 50, -50, size)).toEqual([80, 0, 20, 20]);
    expect(enlarged([40, 90, 20, 20], 5, 10, size)).toEqual([35, 80, 30, 40]);
  });
});

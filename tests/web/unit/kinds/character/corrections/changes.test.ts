import { forPerson, changesOf, isChanged, isEverybody, notesFor, type RevisionDraft, draftOf } from '@web/kinds/character/corrections/changes';
import { defaults } from '@web/kinds/character/choices';
import type { MaskStroke } from '@web/kinds/character/masks/strokes';
import { describe, expect, it } from 'vitest';
import { aJob } from '../../../job';

const of = (options: object, inputs: Record<string, string> = {}) =>
  aJob({ kind: 'character', inputs: { photo: 'x', ...inputs }, options: options as never });
const plain = draftOf(of({}));
const after = (part: Partial<RevisionDraft>, before = plain) => changesOf(before, { ...before, ...part }, {});

describe('a revision', () => {
  it('asks for nothing where nothing was changed', () => {
    const made = { keep: ['arms'], seconds: 2, motion: 'dance', joints: { LeftElbow: [1, 2] }, person_index: 1 };
    const draft = draftOf(of(made));
    expect(changesOf(draft, draftOf(of(made)), {})).toEqual({ corrections: {}, options: {} });
    expect(isChanged(draft, { ...draft, keep: [...draft.keep].reverse() })).toBe(false);
    const filmed = { size: [640, 480], fps: 12.5, format: 'png', triangles: 5000, levels: 1 };
    expect(isChanged(draftOf(of(filmed)), draftOf(of(filmed)))).toBe(false);
  });

  it('puts right what was found, and takes back what is no longer wanted', () => {
    const mask: MaskStroke[] = [{ path: [[1, 2]], radius: 3, person: true }];
    expect(after({ joints: { LeftElbow: [3, 4] }, mask }).corrections).toEqual({
      ...{ joints: { LeftElbow: [3, 4] }, mask_strokes: mask },
    });
    const painted = draftOf(of({ mask_strokes: mask, person_box: [1, 2, 3, 4], camera: 'orbit', keep: ['head'], lit: true }));
    expect(after({ mask: [], box: null, camera: 'fixed', keep: [], lit: false }, painted)).toEqual({
      ...{ corrections: { mask_strokes: null, person_box: null }, options: { camera: null, keep: null, lit: null } },
    });
  });

  it('makes another video, or a finer character, and the usual ones again', () => {
    expect(after({ size: [1024, 1024], rate: 60, format: 'webm', triangles: 200_000, levels: 3 }).options).toEqual({
      ...{ size: [1024, 1024], fps: 60, format: 'webm', triangles: 200_000, levels: 3 },
    });
    const made = draftOf(of({ size: [512, 512], fps: 24, format: 'webp', triangles: 10_000, levels: 2 }));
    expect(after({ size: [1920, 1920] }, made).options).toEqual({ size: [1920, 1920] });
    const { size, rate, format, triangles, levels } = defaults;
    expect(after({ size, rate, format, triangles, levels }, made).options).toEqual({
      ...{ size: null, fps: null, format: null, triangles: null, levels: null },
    });
  });

  it('moves by another clip, or by a file; the file that a clip replaces is named', () => {
    expect(after({ motion: { by: 'name', name: 'bow' } })).toEqual({ corrections: {}, options: { motion: 'bow' } });
    const file = new File(['x'], 'a.bvh');
    expect(changesOf(plain, { ...plain, motion: { by: 'file', file } }, { motion: 'id' }).corrections).toEqual({ motion: 'id' });
    const moved = draftOf(of({}, { motion: '0198c1d2-7b1a-7c3e-9c6d-000000000002' }));
    expect(moved.motion).toEqual({ by: 'held', input: '0198c1d2-7b1a-7c3e-9c6d-000000000002' });
    expect(after({ motion: { by: 'name', name: 'walk' } }, moved)).toEqual({
      ...{ corrections: { motion: null }, options: { motion: 'walk' } },
    });
  });

  it('moves by a kept motion, whose joints are told only where they are not as found', () => {
    const kept = { motion: { by: 'kept', name: 'kick' }, motionJoints: { LeftArm: 'arm_l', Neck: null } } as const;
    expect(after(kept).corrections).toEqual({ motion: 'kick', motion_joints: { LeftArm: 'arm_l', Neck: null } });
    const made = draftOf(of({ motion_joints: { LeftArm: 'arm_l' } }, { motion: 'kick' }));
    expect(changesOf(made, made, {}).corrections).toEqual({});
    expect(after({ motion: { by: 'name', name: 'bow' }, motionJoints: {} }, made).corrections).toEqual({
      ...{ motion: null, motion_joints: null },
    });
    expect(notesFor(of({}), { ...plain, ...kept }).metadata).toEqual({ motion: 'Kick' });
    expect(notesFor(of({}), plain)).toEqual({});
  });

  it('plays another animation of the motion, or the first again', () => {
    const made = draftOf(of({ motion_clip: 'Run' }, { motion: 'kick' }));
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
    const made = draftOf(of({}, { mask: 'm', labels: 'l' }));
    expect(isChanged(made, draftOf(of({}, { mask: 'm', labels: 'l' })))).toBe(false);
    expect(after({ maskFile: null }, made).corrections).toEqual({ mask: null });
    expect(after(forPerson({ person: 1 }), made).corrections).toEqual({ person_index: 1, mask: null, labels: null });
  });

  it('says who is meant where that was asked, the largest too', () => {
    const crowd = aJob({ kind: 'character', status: 'failed', error: { code: 'crowd', detail: 'Choose one.' } });
    expect(after(forPerson({ person: 0 }), draftOf(crowd)).corrections).toEqual({ person_index: 0 });
    expect(after(forPerson({ person: 0 }), draftOf(of({}))).corrections).toEqual({});
    expect(after(forPerson({ person: 0 }), draftOf(of({ person_index: 1 }))).corrections).toEqual({ person_index: 0 });
  });

  it('of somebody else forgets what was put right of the one before', () => {
    const made = draftOf(of({ joints: { LeftElbow: [1, 2] }, person_box: [1, 2, 3, 4], pose: { LeftArm: [0, 0, 9] } }));
    expect(after(forPerson({ person: 'all' }), made)).toEqual({
      corrections: { person_index: 'all', person_box: null, joints: null },
      options: { pose: null },
    });
    expect(after(forPerson({ box: [5, 6, 7, 8] }), made).corrections).toEqual({ person_box: [5, 6, 7, 8], joints: null });
  });

  it('of a box that is taken away is of whoever was chosen before it was drawn', () => {
    const boxed = (draft: RevisionDraft): RevisionDraft => ({ ...draft, ...forPerson({ box: [5, 6, 7, 8] }) });
    const second = draftOf(of({ person_index: 1 }));
    expect(changesOf(second, boxed(second), {}).corrections).toEqual({ person_box: [5, 6, 7, 8] });
    const made = draftOf(of({ person_index: 1, person_box: [5, 6, 7, 8] }));
    expect(after(forPerson({ box: null }), made).corrections).toEqual({ person_box: null });
    for (const person of [0, 1, 'all', null] as const) {
      const before = { ...plain, person };
      expect({ ...boxed(before), ...forPerson({ box: null }) }).toEqual(before);
    }
  });

  it('of a box is of one person, whoever was chosen', () => {
    const everybody = draftOf(of({ person_index: 'all' }));
    expect(isEverybody(everybody)).toBe(true);
    expect(isEverybody({ ...everybody, box: [5, 6, 7, 8] })).toBe(false);
    expect(after(forPerson({ box: [5, 6, 7, 8] }), everybody).corrections).toEqual({ person_index: 0, person_box: [5, 6, 7, 8] });
  });
});

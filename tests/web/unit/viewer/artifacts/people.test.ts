import type { Artifact } from '@web/api';
import type { Skeleton } from '@web/viewer/artifacts/skeleton';
import { peopleOf, standTogether } from '@web/viewer/artifacts/people';
import { describe, expect, it } from 'vitest';
import { aJob } from '../../job';

const file = (name: string): Artifact => ({ url: `/${name}`, size: 1, content_type: '', sha256: '' }) as Artifact;
const left = (...names: string[]) =>
  aJob({ kind: 'character', artifacts: Object.fromEntries(names.map((name) => [name, file(name)])) });
const told = (...woken: NonNullable<Skeleton['woken']>): Skeleton => ({ size: [1, 1], joints: {}, woken });

describe('the people who were woken', () => {
  const job = left('character.glb', 'character-lod1.glb', 'character-2.glb', 'character-2.usdz', 'character-3-lod1.glb');

  it('have a file each; what is another form of one is nobody else', () => {
    expect(peopleOf(job, null).map(({ number, glb, usdz }) => [number, glb.url, usdz?.url])).toEqual([
      [1, '/character.glb', undefined],
      [2, '/character-2.glb', '/character-2.usdz'],
    ]);
    expect(peopleOf(left('animation.mp4'), null)).toEqual([]);
  });

  it('are counted as in the picture, where somebody was left there', () => {
    const skeleton = told({ person: 0, place: [0, 0, 0] }, { person: 2, place: [1, 0, -2] });
    expect(peopleOf(job, skeleton).map(({ number, place }) => [number, place])).toEqual([
      [1, [0, 0, 0]],
      [3, [1, 0, -2]],
    ]);
  });

  it('stand together where it is known how they stood, and are more than one', () => {
    const both = told({ person: 0, place: [0, 0, 0] }, { person: 1, place: [1, 0, 0] });
    expect(standTogether(peopleOf(job, both))).toBe(true);
    expect(standTogether(peopleOf(job, null))).toBe(false);
    expect(standTogether(peopleOf(left('character.glb'), both))).toBe(false);
  });
});

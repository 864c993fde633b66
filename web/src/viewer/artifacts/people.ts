/** Who was woken: the files of each, and where they stood. */

import type { Artifact } from '../../api';
import type { Skeleton } from './skeleton';

/** What a job left, or what a public link opens of it. */
export interface HasArtifacts {
  artifacts: Record<string, Artifact>;
}

export interface CharacterFiles {
  /** Which of the people found, counted from 1. */
  number: number;
  /** Of their files, without the ending. */
  name: string;
  glb: Artifact;
  usdz: Artifact | undefined;
  /** Where the origin of their world is in that of the first, in metres; null where the job does not say it. */
  place: [x: number, y: number, z: number] | null;
}

/** Files of one alone, who was not woken out of a picture. */
const ALONE = ['avatar', 'puppet'];

/** The first is character.glb, the second character-2.glb, and so on; or there is one alone. */
export function peopleOf({ artifacts }: HasArtifacts, skeleton: Skeleton | null): CharacterFiles[] {
  const people: CharacterFiles[] = [];
  const first = ALONE.find((name) => `${name}.glb` in artifacts) ?? 'character';
  for (let index = 0; ; index++) {
    const name = nameOf(index, first);
    const glb = artifacts[`${name}.glb`];
    if (!glb) return people;
    const told = skeleton?.woken?.[index];
    const number = (told?.person ?? index) + 1;
    people.push({ number, name, glb, usdz: artifacts[`${name}.usdz`], place: told?.place ?? null });
  }
}

const nameOf = (index: number, first: string): string => (index === 0 ? first : `${first}-${index + 1}`);

/** A puppet is a face alone: there is no floor that it could stand on. */
export const standOnFloor = ({ artifacts }: HasArtifacts): boolean => !('puppet.glb' in artifacts);

/** Whether all can be shown together, where they stood. */
export const standTogether = (people: readonly CharacterFiles[]): boolean =>
  people.length > 1 && people.every(({ place }) => place !== null);

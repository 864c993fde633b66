/** A stage with characters on it, for as long as a component shows them. */

import type { RefObject } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { getSkeleton, type Skeleton } from '../artifacts/skeleton';
import { type Character, loadCharacter } from './character';
import { peopleOf, type HasArtifacts, type CharacterFiles } from '../artifacts/people';
import { NoWebGL, Stage } from './stage';

/** Somebody who was woken, as a body. */
export interface StagedCharacter {
  character: Character;
  /** How far the ground under them is above that of the first, in the picture; metres. All stand on one floor here. */
  rise: number;
}

export interface LoadedStage {
  stage: Stage;
  skeleton: Skeleton | null;
  people: readonly CharacterFiles[];
  /** In the same order; none of them is on the stage by itself. */
  standing: readonly StagedCharacter[];
}

export interface Staged {
  shown: LoadedStage | null;
  /** Why nothing is shown. */
  trouble: 'no_webgl' | 'character_unreadable' | null;
  retry: () => void;
}

export function useStage(place: RefObject<HTMLElement | null>, job: HasArtifacts): Staged {
  const [shown, setShown] = useState<LoadedStage | null>(null);
  const [trouble, setTrouble] = useState<Staged['trouble']>(null);
  const [turn, setTurn] = useState(0);
  // links are signed anew whenever the job is told of: the files are the same until their paths are others
  const files = peopleOf(job, null).map(({ glb }) => glb.url.split('?')[0]);

  useEffect(() => {
    if (!place.current) return;
    const stop = new AbortController();
    const { signal } = stop;
    let stage: Stage | null = null;
    const loaded: Character[] = [];
    setTrouble(null);
    const load = async (url: string): Promise<Character> => {
      const character = await loadCharacter(url, signal);
      loaded.push(character);
      return character;
    };
    const show = async (): Promise<void> => {
      try {
        stage = new Stage(place.current as HTMLElement);
        const [skeleton, ...characters] = await Promise.all([
          getSkeleton(job, signal).catch(() => null), // those who were woken are there without it
          ...peopleOf(job, null).map(({ glb }) => load(glb.url)),
        ]);
        if (signal.aborted) return;
        const people = peopleOf(job, skeleton);
        const standing = characters.map((character, index): StagedCharacter => {
          const [x, y, z] = people[index]?.place ?? [0, 0, 0];
          character.home.set(x, 0, z);
          character.settle();
          return { character, rise: y };
        });
        setShown({ stage, skeleton, people, standing });
      } catch (error) {
        if (signal.aborted) return;
        stop.abort();
        clear();
        setTrouble(error instanceof NoWebGL ? 'no_webgl' : 'character_unreadable');
      }
    };
    const clear = (): void => {
      for (const character of loaded.splice(0)) character.dispose();
      stage?.dispose();
      stage = null;
    };
    void show();
    return () => {
      stop.abort();
      setShown(null);
      clear();
    };
  }, [files.join(), turn]);

  return { shown, trouble, retry: () => setTurn((n) => n + 1) };
}

/** Those on the stage, and nobody else. */
export function useCast(shown: LoadedStage | null, cast: readonly StagedCharacter[]): void {
  useEffect(() => {
    if (!shown) return;
    const { scene } = shown.stage;
    for (const { character } of cast) scene.add(character.root);
    shown.stage.invalidate();
    return () => {
      for (const { character } of cast) scene.remove(character.root);
    };
  }, [shown, cast]);
}

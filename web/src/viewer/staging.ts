/** A stage with a character on it, for as long as a component shows them. */

import type { RefObject } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { type Character, loadCharacter } from './character';
import { NoWebGL, Stage } from './stage';

export interface Shown {
  stage: Stage;
  character: Character;
}

export interface Staged {
  shown: Shown | null;
  /** Why nothing is shown. */
  trouble: 'no_webgl' | 'character_unreadable' | null;
  retry: () => void;
}

export function useStage(place: RefObject<HTMLElement | null>, url: string | undefined): Staged {
  const [shown, setShown] = useState<Shown | null>(null);
  const [trouble, setTrouble] = useState<Staged['trouble']>(null);
  const [turn, setTurn] = useState(0);
  // a link is signed anew whenever the job is told of: the file is the same until its path is another
  const file = url?.split('?')[0];

  useEffect(() => {
    if (!place.current) return;
    const stop = new AbortController();
    let stage: Stage | null = null;
    let character: Character | null = null;
    setTrouble(null);
    const show = async (): Promise<void> => {
      try {
        const opened = new Stage(place.current as HTMLElement);
        stage = opened;
        character = await loadCharacter(url ?? '', stop.signal);
        opened.scene.add(character.root);
        setShown({ stage: opened, character });
      } catch (error) {
        if (stop.signal.aborted) return;
        stage?.dispose();
        stage = null;
        setTrouble(error instanceof NoWebGL ? 'no_webgl' : 'character_unreadable');
      }
    };
    void show();
    return () => {
      stop.abort();
      setShown(null);
      character?.dispose();
      stage?.dispose();
    };
  }, [file, turn]);

  return { shown, trouble, retry: () => setTurn((n) => n + 1) };
}

/** What is being chosen on the start pages. The whole page holds it, so that a look at another page loses nothing. */

import { useState } from 'preact/hooks';
import type { MotionJoints } from './api';
import { type Choices as CharacterChoices, usual as usualCharacter } from './kinds/character/choices';
import { type Choices as PortraitChoices, usual as usualPortrait } from './kinds/portrait/choices';
import type { Performance } from './kinds/portrait/performances';
import { USUAL_MOTION } from './names';
import type { Motion } from './order';

export interface PortraitDraft {
  portrait: File | null;
  /** Null: nobody has chosen yet. */
  performance: Performance | null;
  choices: PortraitChoices;
}

export interface CharacterDraft {
  photo: File | null;
  motion: Motion;
  joints: MotionJoints;
  /** Which of the motion's animations. */
  clip: string | null;
  choices: CharacterChoices;
}

/** What is chosen, and what changes a part of it. */
export type Draft<T> = readonly [T, (part: Partial<T>) => void];

export const noPortrait: PortraitDraft = { portrait: null, performance: null, choices: usualPortrait };
export const noCharacter: CharacterDraft = {
  ...{ photo: null, motion: { by: 'name', name: USUAL_MOTION }, joints: {}, clip: null, choices: usualCharacter },
};

export function useDraft<T>(nothing: T): Draft<T> {
  const [value, setValue] = useState(nothing);
  return [value, (part) => setValue((known) => ({ ...known, ...part }))];
}

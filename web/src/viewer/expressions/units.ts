/** What a face can do: ARKit's 52 face units by parts of the face, mixtures of them, and Oculus' 15 visemes. */

const sided = (...names: string[]): string[] => names.flatMap((name) => [`${name}Left`, `${name}Right`]);

export type UnitGroup = 'eyes' | 'brows' | 'mouth' | 'jaw' | 'cheeks';

export const groups: Readonly<Record<UnitGroup, readonly string[]>> = {
  eyes: sided('eyeBlink', 'eyeWide', 'eyeSquint', 'eyeLookUp', 'eyeLookDown', 'eyeLookIn', 'eyeLookOut'),
  brows: ['browInnerUp', ...sided('browOuterUp', 'browDown')],
  mouth: [
    ...sided('mouthSmile', 'mouthFrown', 'mouthDimple', 'mouthStretch', 'mouthPress', 'mouthUpperUp', 'mouthLowerDown'),
    ...['mouthClose', 'mouthFunnel', 'mouthPucker', 'mouthLeft', 'mouthRight'],
    ...['mouthRollUpper', 'mouthRollLower', 'mouthShrugUpper', 'mouthShrugLower'],
  ],
  jaw: ['jawOpen', 'jawForward', 'jawLeft', 'jawRight', 'tongueOut'],
  cheeks: ['cheekPuff', ...sided('cheekSquint', 'noseSneer')],
};

/** How much of each unit or viseme a face shows, from 0 to 1; nothing of those that are not named. */
export type Expression = Readonly<Record<string, number>>;

const both = (name: string, share: number): Expression => ({ [`${name}Left`]: share, [`${name}Right`]: share });

export type MixtureName = 'smile' | 'surprise' | 'sad' | 'angry' | 'blink' | 'wink';

export const mixtures: Readonly<Record<MixtureName, Expression>> = {
  smile: { ...both('mouthSmile', 0.8), ...both('cheekSquint', 0.4), ...both('eyeSquint', 0.25) },
  surprise: { browInnerUp: 0.9, ...both('browOuterUp', 0.8), ...both('eyeWide', 0.8), jawOpen: 0.4 },
  sad: { browInnerUp: 0.8, ...both('mouthFrown', 0.8), mouthShrugLower: 0.3, ...both('eyeLookDown', 0.3) },
  angry: { ...both('browDown', 1), ...both('noseSneer', 0.5), ...both('mouthPress', 0.5), ...both('eyeSquint', 0.4) },
  blink: both('eyeBlink', 1),
  wink: { eyeBlinkLeft: 1, mouthSmileLeft: 0.5, cheekSquintLeft: 0.5 },
};

/** By the sounds that they stand for; the target's name has `viseme_` before it. */
export const visemes = ['sil', 'PP', 'FF', 'TH', 'DD', 'kk', 'CH', 'SS', 'nn', 'RR', 'aa', 'E', 'I', 'O', 'U'] as const;

export const visemeTarget = (viseme: string): string => `viseme_${viseme}`;

/** `mouthSmileLeft` as words and a side: `Mouth smile`, `Left`. Units such as `jawLeft` go to a side and have none. */
export function unitWords(unit: string): { name: string; side: 'Left' | 'Right' | null } {
  const [, stem = unit, side] = /^([a-z]+[A-Z]\w*?)(Left|Right)$/.exec(unit) ?? [];
  const spaced = stem.replace(/([A-Z])/g, (letter) => ` ${letter.toLowerCase()}`);
  return { name: spaced.charAt(0).toUpperCase() + spaced.slice(1), side: (side as 'Left' | 'Right' | undefined) ?? null };
}

/** The joints that can be shown in frames of a clip, by MediaPipe's names, and points of them that are moved. */

import { plain } from '../../../language/strings';
import { words as avatarWords } from '../words';
import type { Landmarks } from './changes';

const words = avatarWords.place;
const parts = ['Shoulder', 'Elbow', 'Wrist', 'Index', 'Hip', 'Knee', 'Ankle', 'Heel', 'FootIndex'] as const;

export const jointNames: readonly string[] = ['Nose', ...parts.flatMap((part) => [`Left${part}`, `Right${part}`])];

/** `Left elbow`. */
export function landmarkName(name: string): string {
  const [, side, part = ''] = /^(Left|Right)(\w+)$/.exec(name) ?? [];
  const known = words.names[part];
  if (!side || !known) return words.names[name] ?? plain(name);
  return side === 'Left' ? words.left(known) : words.right(known);
}

/** Where a joint is shown in a frame; null where it is not. */
export const placeIn = (landmarks: Landmarks, joint: string, frame: number): readonly [number, number] | null =>
  landmarks[joint]?.find((one) => one.frame === frame)?.place ?? null;

/** With a joint at another place of a frame, or at none of it. */
export function withPlace(landmarks: Landmarks, joint: string, frame: number, place: readonly [number, number] | null): Landmarks {
  const others = (landmarks[joint] ?? []).filter((one) => one.frame !== frame);
  const places = place ? [...others, { frame, place }].sort((one, other) => one.frame - other.frame) : others;
  const { [joint]: _before, ...rest } = landmarks;
  return places.length ? { ...rest, [joint]: places } : rest;
}

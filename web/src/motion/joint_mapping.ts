/** Which joint of a motion's file moves which of a character's: as it was found, and as it is wanted. */

import type { MotionDetails, MotionJoints } from './types';
import { words as viewerWords } from '../viewer/words';
import { words } from './words';

const sides = ['Left', 'Right'] as const;
const fingers = ['Thumb', 'Index', 'Middle', 'Ring', 'Pinky'] as const;
const arm = ['Shoulder', 'Arm', 'ForeArm', 'Hand'];
const leg = ['UpLeg', 'Leg', 'Foot', 'ToeBase'];
const of = (side: string, parts: readonly string[]): string[] => parts.map((part) => side + part);
const hand = (side: string): string[] => fingers.flatMap((finger) => [1, 2, 3].map((n) => `${side}Hand${finger}${n}`));

/** Our joints that a motion can move, by the parts of the body. */
export const groups = {
  trunk: ['Hips', 'Spine', 'Spine1', 'Spine2', 'Neck', 'Head'],
  leftArm: of('Left', arm),
  rightArm: of('Right', arm),
  leftLeg: of('Left', leg),
  rightLeg: of('Right', leg),
  leftFingers: hand('Left'),
  rightFingers: hand('Right'),
} as const;
export type Group = keyof typeof groups;

/** Those without which nobody can be moved. */
export const required: readonly string[] = [
  'Hips',
  ...sides.flatMap((side) => of(side, ['UpLeg', 'Leg', 'Foot', 'Arm', 'ForeArm'])),
];

type Found = MotionDetails['mapping'];

/** The motion's joint that moves one of ours; null where none does. */
export const moverOf = (joint: string, found: Found, wanted: MotionJoints): string | null =>
  wanted[joint] === undefined ? (found[joint] ?? null) : wanted[joint];

/** With one of our joints moved by another of the motion's; what is as found need not be said. */
export function moved(joint: string, mover: string | null, found: Found, wanted: MotionJoints): MotionJoints {
  const others = Object.fromEntries(Object.entries(wanted).filter(([name]) => name !== joint));
  return mover === (found[joint] ?? null) ? others : { ...others, [joint]: mover };
}

/** The joints that must be moved by something, and are not. */
export const missing = (found: Found, wanted: MotionJoints): string[] =>
  required.filter((joint) => moverOf(joint, found, wanted) === null);

/** What all names begin with, up to a colon, a bar or an underscore: exporters put it before each. */
export function commonPrefix(names: readonly string[]): string {
  const shared = names.reduce((one, other) => {
    let length = 0;
    while (length < one.length && one[length] === other[length]) length += 1;
    return one.slice(0, length);
  }, names[0] ?? '');
  const prefix = /^.*[:|_]/.exec(shared)?.[0] ?? '';
  return names.some((name) => name.length === prefix.length) ? '' : prefix;
}

/** `Left upper arm`; `Left index finger, 2`. */
export function jointName(joint: string): string {
  const { bones } = viewerWords;
  const [, side, finger, number] = /^(Left|Right)Hand(\D+)(\d)$/.exec(joint) ?? [];
  if (!side || !finger) return bones[joint] ?? joint;
  return words.joints.finger(words[side === 'Left' ? 'left' : 'right'](words.joints.fingers[finger] ?? finger), number ?? '');
}

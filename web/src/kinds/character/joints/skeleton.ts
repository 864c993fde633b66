/** The joints of a person in a picture, by the names of skeleton.json; "left" is the person's own. */

import type { Frame } from '../../../api';
import type { Skeleton } from '../../../viewer/artifacts/skeleton';
import type { Point } from '../../../picture_editor/geometry';
import { words as characterWords } from '../words';

/** Places by name, in pixels of the picture. */
export type Joints = Readonly<Record<string, Point>>;

const sides = ['Left', 'Right'] as const;
const both = (name: string): string[] => sides.map((side) => side + name);

/** What has to be placed where nobody was found, from the shoulders down. */
export const needed: readonly string[] = ['Shoulder', 'Elbow', 'Wrist', 'Hip', 'Knee', 'Ankle'].flatMap(both);

/** The joints that stand for the whole; the others are details of hands, feet and face. */
const main = new Set(['Nose', ...needed]);
export const isDetail = (name: string): boolean => !main.has(name);

const limbNames: readonly (readonly [string, string])[] = [
  ['Shoulder', 'Elbow'],
  ['Elbow', 'Wrist'],
  ['Shoulder', 'Hip'],
  ['Hip', 'Knee'],
  ['Knee', 'Ankle'],
  ['Wrist', 'Pinky'],
  ['Wrist', 'Index'],
  ['Wrist', 'Thumb'],
  ['Ankle', 'Heel'],
  ['Ankle', 'FootIndex'],
  ['Eye', 'Ear'],
];

/** Lines from joint to joint, each of the left, the right, or neither. */
export const limbs: readonly { from: string; to: string; side: 'left' | 'right' | null }[] = [
  { from: 'LeftShoulder', to: 'RightShoulder', side: null },
  { from: 'LeftHip', to: 'RightHip', side: null },
  ...limbNames.flatMap(([from, to]) => [
    { from: `Left${from}`, to: `Left${to}`, side: 'left' as const },
    { from: `Right${from}`, to: `Right${to}`, side: 'right' as const },
  ]),
  { from: 'Nose', to: 'LeftEye', side: 'left' },
  { from: 'Nose', to: 'RightEye', side: 'right' },
  { from: 'MouthLeft', to: 'MouthRight', side: null },
];

/** Details that go along with a joint. */
const followers: Record<string, readonly string[]> = {
  Nose: [...both('Eye'), ...both('Ear'), 'MouthLeft', 'MouthRight'],
  ...Object.fromEntries(
    sides.flatMap((side) => [
      [`${side}Wrist`, ['Pinky', 'Index', 'Thumb'].map((name) => side + name)],
      [`${side}Ankle`, ['Heel', 'FootIndex'].map((name) => side + name)],
    ]),
  ),
};

/** Each joint's share in a move of one of them: a hand, a foot and the face come along with their joint. */
export function sharesOf(names: readonly string[], chosen: string | null): number[] {
  const along = new Set(chosen === null ? names : [chosen, ...(followers[chosen] ?? [])]);
  return names.map((name) => (along.has(name) ? 1 : 0));
}

export const sideOf = (name: string): 'left' | 'right' | null =>
  /^Left|Left$/.test(name) ? 'left' : /^Right|Right$/.test(name) ? 'right' : null;

/** `Left elbow`. */
export function labelOf(name: string): string {
  const words = characterWords.joints;
  const plain = name.replace(/^(Left|Right)|(Left|Right)$/g, '');
  const known = words.names[plain] ?? plain;
  const side = sideOf(name);
  return side === null ? known : words[side](known);
}

/** Every joint where the one of the other side was. */
export function swapped(joints: Joints): Joints {
  const other = (name: string): string =>
    name.replace(/^(Left|Right)|(Left|Right)$/, (side) => (side === 'Left' ? 'Right' : 'Left'));
  return Object.fromEntries(Object.entries(joints).map(([name, place]) => [name, joints[other(name)] ?? place]));
}

/** Somebody who stands, seen from the front: x from the middle, y from the crown, both in body heights. */
const standing: Record<string, Point> = {
  Shoulder: [0.11, 0.19],
  Elbow: [0.17, 0.34],
  Wrist: [0.21, 0.48],
  Hip: [0.06, 0.52],
  Knee: [0.07, 0.73],
  Ankle: [0.075, 0.94],
};
const HALF_WIDTH = 0.24;

/** A skeleton to begin with: in a frame around the person, or in the middle of a picture. */
export function skeletonIn([x, y, width, height]: Frame): Joints {
  const tall = Math.min(height, width / (2 * HALF_WIDTH));
  const [middle, crown] = [x + width / 2, y + (height - tall) / 2];
  return Object.fromEntries(
    needed.map((name) => {
      const side = sideOf(name);
      const [dx, dy] = standing[name.replace(/^(Left|Right)/, '')] ?? [0, 0];
      return [name, [middle + (side === 'left' ? dx : -dx) * tall, crown + dy * tall]];
    }),
  );
}

/** The middle of a picture, with a little room at its edges. */
export const middleOf = ([width, height]: readonly [number, number]): Frame => [
  0.06 * width,
  0.06 * height,
  0.88 * width,
  0.88 * height,
];

/** The joints that were found, or placed before. */
export const jointsOf = (skeleton: Skeleton): Joints =>
  Object.fromEntries(Object.entries(skeleton.joints).map(([name, { place }]) => [name, place]));

/** Pixels by which a joint has to be moved to count as placed. */
const MOVED = 0.05;

/**
 * The joints to send: what was placed before, and what is elsewhere than it was found. Where nothing was found, all.
 * How far beyond its edges the service takes joints for those of the picture bounds them.
 */
export function placedJoints(
  joints: Joints,
  found: Joints | null,
  before: Joints | null,
  [width, height]: readonly [number, number],
): Record<string, [number, number]> {
  const within = (value: number, length: number): number =>
    Math.round(Math.min(1.25 * length, Math.max(-0.25 * length, value)) * 10) / 10;
  const moved = Object.entries(joints).filter(([name, [x, y]]) => {
    const was = found?.[name];
    return !was || before?.[name] || Math.hypot(was[0] - x, was[1] - y) > MOVED;
  });
  return Object.fromEntries(moved.map(([name, [x, y]]) => [name, [within(x, width), within(y, height)]]));
}

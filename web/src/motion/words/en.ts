/** English: the motion that somebody moves by, and the joints of a file that move theirs. */

import type { MotionName } from '../types';

const english = {
  motion: 'Motion',
  builtIn: 'Built-in motions',
  names: {
    idle: 'Idle',
    walk: 'Walk',
    run: 'Run',
    jump: 'Jump',
    sit: 'Sit down',
    wave: 'Wave',
    dance: 'Dance',
    bow: 'Bow',
  } satisfies Record<MotionName, string>,
  kept: 'Your saved motions',
  own: 'Upload a motion',
  drop: 'Drop a BVH, GLB or glTF file here',
  browse: 'or choose one',
  chosen: (name: string) => `Motion: ${name}. Choose another`,
  wrong: 'This is not a motion file. Please choose a BVH file, or a GLB file with an animated skeleton.',
  held: 'An uploaded motion',

  joints: {
    title: 'Joints of the motion',
    clip: 'Animation',
    firstClip: 'First animated one',
    hint: 'Left: the character’s joints. Right: the joints of the motion that drive them. Change the mapping where a limb moves wrongly; joints that nothing drives follow their parent.',
    looking: 'Reading the motion.',
    nothing: 'None',
    wanting: (joints: string) => `These joints are required and not mapped yet: ${joints}.`,
    changed: (number: number) => `${number} changed`,
    asFound: 'Reset mapping',
    hands: 'Fingers',
    groups: {
      trunk: 'Trunk and head',
      leftArm: 'Left arm',
      rightArm: 'Right arm',
      leftLeg: 'Left leg',
      rightLeg: 'Right leg',
      leftFingers: 'Left hand',
      rightFingers: 'Right hand',
    },
    fingers: {
      Thumb: 'thumb',
      Index: 'index finger',
      Middle: 'middle finger',
      Ring: 'ring finger',
      Pinky: 'little finger',
    } as Record<string, string>,
    finger: (finger: string, number: string) => `${finger}, ${number}`,
  },

  /** The person's own. */
  left: (name: string) => `Left ${name}`,
  right: (name: string) => `Right ${name}`,
};

export type MotionWords = typeof english;

export default english;

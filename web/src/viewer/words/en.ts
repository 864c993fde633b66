/** English: characters in 3D, to be looked at, posed, and hung on a wall. */

import type { MixtureName, UnitGroup } from '../expressions/units';

const english = {
  label: 'In 3D',
  modes: 'What to do',
  modeNames: { wall: 'On the wall', look: 'Look around', pose: 'Change the pose', film: 'Video' },
  stage: 'The character in 3D: arrow keys circle around it, plus and minus go nearer and further',
  stageOfSeveral: 'The characters in 3D: arrow keys circle around them, plus and minus go nearer and further',
  people: 'Who',
  everybody: 'Everyone',
  person: (number: number) => `Person ${number}`,
  tools: 'View',
  loading: 'Loading the character',
  noWebGL: 'This browser shows no 3D (WebGL is missing or switched off). The video and all files are not affected.',
  failed: 'Check the connection and try again.',
  help: 'Drag to rotate, pinch or scroll to zoom, two fingers or the right button to pan.',
  clip: 'Motion',
  /** The project's own clips; a motion file's keeps its name. */
  clips: {
    pictured: 'Pose from the picture',
    step_out: 'Out of the picture',
    filmed: 'Pose of the capture',
    idle: 'Idle',
    walk: 'Walk',
    run: 'Run',
    jump: 'Jump',
    sit: 'Sit down',
    wave: 'Wave',
    dance: 'Dance',
    bow: 'Bow',
  } as Record<string, string>,
  inPlace: (clip: string) => `${clip}, in place`,
  skeleton: 'Skeleton',
  dark: 'Dark background',
  light: 'Light background',
  reset: 'View from the front',
  smaller: 'Leave full screen',

  poseHelp: 'Drag a dot and the limb follows. Circle around to drag it in another direction, or choose a bone and turn it.',
  poseForAll: (people: number) =>
    `It is made for all ${people} people: each of them turns the same joints, from their own pose in the picture.`,
  bone: 'Bone',
  /** Left and right are the person's own. */
  bones: {
    Hips: 'Hips',
    Spine: 'Waist',
    Spine1: 'Belly',
    Spine2: 'Chest',
    Neck: 'Neck',
    Head: 'Head',
    LeftShoulder: 'Left shoulder',
    LeftArm: 'Left upper arm',
    LeftForeArm: 'Left forearm',
    LeftHand: 'Left hand',
    LeftUpLeg: 'Left thigh',
    LeftLeg: 'Left lower leg',
    LeftFoot: 'Left foot',
    LeftToeBase: 'Left toes',
    RightShoulder: 'Right shoulder',
    RightArm: 'Right upper arm',
    RightForeArm: 'Right forearm',
    RightHand: 'Right hand',
    RightUpLeg: 'Right thigh',
    RightLeg: 'Right lower leg',
    RightFoot: 'Right foot',
    RightToeBase: 'Right toes',
  } as Record<string, string>,
  /** About x, y and z. */
  turns: ['Forwards and back', 'Twist', 'Sideways'],
  armTurns: ['Twist', 'Forwards and back', 'Up and down'],
  degrees: (angle: number) => `${angle} degrees`,
  asPictured: 'Pose from the picture',
  makeIt: 'Apply pose',

  cloud: {
    label: 'Measured',
    stage: 'The measured points in 3D: arrow keys circle around them, plus and minus go nearer and further',
    loading: 'Loading the points',
    points: (count: string) => `${count} of the measured points.`,
    cameras: 'Show where the camera stood',
    shape: 'Show the fitted shape instead of the points',
  },

  face: {
    title: 'Expressions',
    closeUp: 'Close-up',
    reset: 'Reset face',
    mixtures: 'Expressions to try',
    mixtureNames: {
      smile: 'Smile',
      surprise: 'Surprise',
      sad: 'Sad',
      angry: 'Angry',
      blink: 'Blink',
      wink: 'Wink',
    } satisfies Record<MixtureName, string>,
    visemes: 'Visemes',
    viseme: (name: string) => `Mouth as for “${name}”`,
    groups: {
      eyes: 'Eyes',
      brows: 'Brows',
      mouth: 'Mouth',
      jaw: 'Jaw and tongue',
      cheeks: 'Cheeks and nose',
    } satisfies Record<UnitGroup, string>,
    left: (unit: string) => `${unit}, left`,
    right: (unit: string) => `${unit}, right`,
    percent: (value: number) => `${Math.round(100 * value)}%`,
  },

  space: 'View in your space',
  spaceAlt: 'The character, to be turned and seen from all sides',
  spaceHint: 'The camera opens; choose a place on the floor.',
  spaceNone: 'This device has no AR. Open this page on a phone or a tablet with AR to place the character in your space.',
  spaceOpen: 'Open the camera',

  wallHelp: 'The picture hangs on the wall. Play, and the person steps out of it; drag to walk around.',
  wallOut: 'Drag to walk around.',
  wallBack: 'Back into the picture',
  headset: 'View in VR headset',
  headsetFailed: 'The VR headset could not be started. Check that it is connected and that this page may use it.',
};

export type ViewerWords = typeof english;

export default english;

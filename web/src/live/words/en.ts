/** English: portraits that follow the camera. */

import type { Obstacle } from '../../api';

const english = {
  open: 'Drive live',
  openHint: 'The portrait follows your camera as you move.',
  title: 'Drive the portrait live',
  alt: 'The portrait, following your camera',
  you: 'You, as the camera sees you',
  states: {
    camera: 'Opening the camera…',
    sending: 'Sending the portrait…',
    preparing: 'Preparing the portrait…',
    calibrating: 'Look into the camera calmly: eyes open, mouth shut.',
    live: 'Live. Move, speak, smile.',
    no_face: 'No face is seen: the portrait holds still.',
    searching: 'No face is seen yet. Sit before the camera.',
    ended: 'The live portrait has ended.',
  },
  obstacles: {
    turned: 'Turn your head towards the camera.',
    eyes_shut: 'Open your eyes.',
    mouth_open: 'Shut your mouth for a moment.',
    moving: 'Hold still for a moment.',
  } satisfies Record<Obstacle, string>,
  progress: 'Calibration',
  rate: (frames: number) => `${frames} frames a second`,
  recalibrate: 'Calibrate again',
  record: 'Record',
  stop: 'Stop and keep',
  recording: 'Recording. The take becomes an ordinary video of this portrait.',
  takeName: 'My live take',
  alone: 'Picture alone',
  aloneHint: 'Opens a page with nothing but the picture, for OBS or full screen.',
  again: 'Begin anew',
  waiting: 'Waiting for the live portrait…',
};

export type LiveWords = typeof english;
export default english;

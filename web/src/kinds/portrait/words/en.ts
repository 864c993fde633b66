/** English: what is said of portraits wherever kinds are named. */

import type { Part, PortraitOptions } from '../types';

const english = {
  label: 'Portrait',
  demo: 'The portrait smiling',
  samples: {
    'grace-hopper': 'Grace Hopper, photographed by the US Navy',
    'eileen-collins': 'Eileen Collins, photographed by NASA',
    'painted-man': 'A man, painted for Galatea',
    'rendered-man': 'A man, rendered for Galatea',
  },
  sharedTitle: 'A portrait brought to life',

  parts: { eyes: 'Eyes', brows: 'Brows', mouth: 'Mouth', head: 'Head' } satisfies Record<Part, string>,

  /** By the names that the engine gives them. */
  stages: {
    find_face: 'Finding the face',
    choose_driver: 'Choosing the performance',
    driver_looks: 'Comparing the performances',
    separate_layers: 'Separating the person from the background',
    rig_target: 'Rigging the portrait',
    track_driver: 'Tracking the performance',
    register_driver: 'Tracking the skin',
    ratio_images: 'Finding creases and wrinkles',
    glance_at_driver: 'Checking the performance',
    look_again: 'Comparing the face with the performance',
    animate: 'Animating',
  },

  /** What went wrong, by code. The sentence that says what to do comes from the service. */
  failures: {
    no_face: 'No face was found',
    face_too_turned: 'The face is turned too far',
    face_too_small: 'The face is too small',
    mouth_too_open: 'The mouth is open too wide',
    face_index_out_of_range: 'There are fewer faces in the picture',
    driver_face_out_of_range: 'There are fewer faces in the performance',
    landmarks_invalid: 'The landmarks cannot be used',
    crop_outside: 'The crop does not fit the picture',
    neutral_frame_out_of_range: 'The part of the performance has no such frame',
    trim_outside: 'There is nothing in that part of the video',
    no_driver_fits: 'No performance fits the picture',
    performance_not_installed: 'A performance is not installed',
    no_face_in_driver: 'No face was found in the performance',
    profile_unplayable: 'The portrait cannot be played',
  },

  /** Inputs and options, as they are named where versions of a work are told apart. */
  differences: {
    driver: 'performance',
    image: 'picture',
    size: 'size',
    fps: 'frames per second',
    format: 'file format',
    neutral_frame: 'neutral frame',
    face_index: 'face',
    driver_face_index: 'face in the video',
    strength: 'strength',
    follow: 'what moves',
    head_3d: 'turn of the head',
    crop: 'crop',
    trim: 'part of the performance',
    loop: 'loop',
    sound: 'sound',
    landmarks: 'landmarks',
    reactive: 'interactive',
  } satisfies Record<keyof PortraitOptions | 'image' | 'driver', string>,
};

export type PortraitWords = typeof english;

export default english;

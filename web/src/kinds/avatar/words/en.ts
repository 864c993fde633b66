/** English: avatars: their studio, and what is said of them wherever kinds are named. */

const english = {
  label: 'Avatar',
  sharedTitle: 'An avatar made of two clips',
  result: 'The avatar',
  glb: 'Avatar for games (GLB)',
  usdz: 'For AR on Apple devices (USDZ)',
  video: 'Seen from all around',

  /** By the names that the engine gives them. */
  stages: {
    choose_frames: 'Choosing frames',
    find_cameras: 'Finding where the camera stood',
    measure_cloud: 'Measuring the surface',
    find_landmarks: 'Finding joints and face',
    fit_template: 'Fitting the body model',
    stitch_texture: 'Making the texture',
    capture_face: 'Reading the driver’s face',
    write_avatar: 'Writing the avatar',
    turntable: 'Filming it from all around',
    animate: 'Animating',
  },

  /** What went wrong, by code. The sentence that says what to do comes from the service. */
  failures: {
    clip_too_short: 'The clip is too short',
    too_dark: 'The clip is too dark',
    too_blurred: 'The clip is blurred',
    camera_stands_still: 'The camera does not go around the person',
    cameras_not_found: 'It could not be found where the camera stood',
    person_not_measured: 'The person’s shape could not be measured',
    cloud_too_thin: 'Too little of the person was measured',
    landmarks_needed: 'The person’s joints were not found',
    landmark_unknown: 'A landmark has a name that is none',
    frame_not_used: 'A landmark is placed in a frame that is not used',
    person_unseen: 'No frame shows the person',
  },

  /** Inputs, options and corrections, as they are named where versions of a work are told apart. */
  differences: {
    body: 'body clip',
    head: 'head clip',
    motion: 'motion',
    driver: 'driver',
    height_m: 'height',
    body_frames_left_out: 'frames left out of the body clip',
    head_frames_left_out: 'frames left out of the head clip',
    landmarks: 'joints',
    body_frames: 'frames of the body',
    head_frames: 'frames of the head',
    texture_size: 'texture',
    triangles: 'triangles',
    levels: 'levels of detail',
    vrm: 'VRM file',
    vrm_author: 'author',
    motion_joints: 'joints of the motion',
    motion_clip: 'animation of the motion',
    size: 'size',
    fps: 'frames per second',
    seconds: 'length',
  },

  /** Files, by what they are to an order. */
  files: { body: 'the body clip', head: 'the head clip', motion: 'the motion', driver: 'the driver' },
};

export type AvatarWords = typeof english;

export default english;

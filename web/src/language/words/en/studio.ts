/** English: what all studios say, how far an order has been sent, and the camera. */

export const studio = {
  samples: {
    label: 'Try one of these',
    failed: 'The picture could not be fetched. Please try again.',
  },

  demo: {
    before: 'The picture',
    after: 'The result',
    play: 'Play animation',
    pause: 'Pause animation',
  },

  studio: {
    pictureDrop: 'Drop a picture here',
    pictureBrowse: 'or choose one, or paste it',
    noPreview: 'This browser cannot show a preview.',
    wrongPicture: 'This is not a picture. Please choose a JPEG, PNG, WebP or HEIC file.',
    options: 'Options',
    chosen: (picture: string, performance: string) => `${picture} · ${performance}`,
    uploading: (part: string, percent: string) => `Uploading ${part}: ${percent}`,
    oneOf: (part: string, number: number, count: number) => `${part} ${number} of ${count}`,
    ordering: 'Starting',
    stop: 'Stop',
    pause: 'Pause',
    resume: 'Resume',
    pausedAt: (part: string, percent: string) => `Paused while uploading ${part}: ${percent}`,
    waiting: (picture: string, performance: string) =>
      `The upload of “${picture}” (${performance}) was interrupted. It continues where it stopped.`,
    goOn: 'Resume upload',
    forget: 'Discard',
  },

  video: {
    size: 'Size',
    sizeUpTo: (side: number) => `Up to ${side} × ${side} pixels`,
    rate: 'Frames per second',
    format: 'File format',
    formats: { mp4: 'MP4', webm: 'WebM', webp: 'WebP (animated)' },
  },

  camera: {
    openPicture: 'Take a picture',
    openRecorder: 'Record yourself',
    pictureTitle: 'Take a picture',
    recordTitle: 'Record a performance',
    live: 'What the camera sees',
    pictureHints: {
      face: 'Look at the camera, eyes open, mouth closed, light on your face.',
      body: 'From head to feet, from the front, arms a little away from the body.',
    },
    takenHints: {
      face: 'Is the whole face in the picture, and sharp?',
      body: 'Are head and feet in the picture, and sharp?',
    },
    takenAlt: 'The picture that was taken',
    take: 'Take the picture',
    again: 'Take again',
    usePicture: 'Use this picture',
    pictureName: 'My picture',
    recordHints: {
      idle: 'Start and end with a neutral face, eyes open, mouth closed. The portrait follows what you do in between.',
      counting: 'Recording starts in three seconds.',
      running: 'Recording.',
      done: 'Recorded. Check it, then use it or record again.',
    },
    withSound: 'With sound',
    record: 'Record',
    giveUp: 'Cancel',
    stop: 'Stop recording',
    reviewAlt: 'Your recording',
    useRecording: 'Use this recording',
    recordingName: 'My performance',
  },
};

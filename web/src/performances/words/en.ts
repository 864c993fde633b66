/** English: performances: the built-in ones, one's own, and a video at hand. */

const english = {
  performances: 'Built-in performances',
  yours: 'Your saved videos',
  states: {
    idle: 'Idle',
    happy: 'Happy',
    surprise: 'Surprise',
    anger: 'Anger',
    fear: 'Fear',
    sadness: 'Sadness',
    nod: 'Nod',
    shake: 'Shake',
    wink: 'Wink',
    talk: 'Talk',
  },
  strong: (state: string) => `${state}, strong`,
  strengths: 'Intensity',
  strengthNames: { normal: 'Normal', strong: 'Strong' },
  moment: (state: string, number: string, seconds: string) => `${state}${number && ` ${number}`}, ${seconds} s`,
  momentOf: (driver: string, start: string, end: string) => `${driver}, from ${start} to ${end} s`,
  searching: (driver: string) => `Looking for emotions in “${driver}”.`,
  nothingFound: (driver: string) => `No emotion that starts and ends with a neutral look was found in “${driver}”.`,
  notSearched: (driver: string) => `“${driver}” could not be searched for emotions.`,
  keep: 'Save it and find the emotions in it',
  keepHint: 'Each part that starts and ends with a neutral look is offered as a performance.',
  ownVideo: {
    title: 'Upload a video',
    drop: 'Drop a video here',
    chosen: (name: string) => `Video: ${name}. Choose another`,
    wrong: 'This is not a video. Please choose an MP4, MOV, WebM, MKV or GIF file.',
  },
  ownEither: {
    title: 'Upload a video or a picture',
    drop: 'Drop a video or a picture here',
    chosen: (name: string) => `Performance: ${name}. Choose another`,
    wrong: 'This is neither a video nor a picture.',
  },
  videoBrowse: 'or choose one',
  /** Files, by what they are to an order. */
  files: { video: 'the video' },
};

export type PerformanceWords = typeof english;

export default english;

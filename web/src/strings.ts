/** Every word of the page. A second language is a second file of this shape. */

import type { Part, Status } from './api';

export const strings = {
  name: 'Galatea',
  home: 'Galatea, start page',
  skip: 'Skip to the content',

  studio: {
    title: 'Bring a portrait to life',
    lead: 'Choose a picture of a face and a performance. The picture acts it out, on this machine alone.',
    portrait: 'Portrait',
    portraitHint: 'A photo, painting or drawing of a face that looks at you, eyes open, mouth closed.',
    portraitDrop: 'Drop a picture here',
    portraitBrowse: 'or choose one, or paste it',
    portraitChosen: (name: string) => `Portrait: ${name}. Choose another`,
    performance: 'Performance',
    performanceHint: 'One of ours, or a video of a face that begins calmly.',
    performances: 'Built-in performances',
    yours: 'Your own drivers',
    ownVideo: 'Your own video',
    videoDrop: 'Drop a video here',
    videoBrowse: 'or choose one',
    videoChosen: (name: string) => `Video: ${name}. Choose another`,
    noPreview: 'No preview in this browser; the file is fine.',
    wrongPicture: 'That is not a picture. Please choose a JPEG, PNG, WebP or HEIC file.',
    wrongVideo: 'That is not a video. Please choose an MP4, MOV, WebM, MKV or GIF file.',
    options: 'Options',
    strength: 'Strength',
    strengthHint: 'How far the expression goes: 100% is as performed.',
    follow: 'What follows the performance',
    sound: 'Keep the sound of the video',
    start: 'Bring it to life',
    needPortrait: 'First choose a portrait.',
    needPerformance: 'Now choose a performance.',
    uploading: (part: string, percent: string) => `Sending ${part}: ${percent}`,
    uploadingPortrait: 'the portrait',
    uploadingVideo: 'the video',
    ordering: 'Starting',
    stop: 'Stop',
  },

  parts: { eyes: 'Eyes', brows: 'Brows', mouth: 'Mouth', head: 'Head' } satisfies Record<Part, string>,

  recent: {
    title: 'Recent',
    empty: 'What you make will appear here.',
    more: 'Show more',
  },

  job: {
    title: (portrait: string) => portrait,
    performance: (name: string) => `performs “${name}”`,
    back: 'Make another',
    queued: 'Waiting for its turn',
    starting: 'Starting',
    left: (duration: string) => `about ${duration} left`,
    done: (percent: string) => `${percent} done`,
    progress: 'Progress',
    stages: 'Stages',
    stageDone: 'done',
    stageRunning: 'running',
    preview: 'First impression',
    previewAlt: 'A first frame of the result',
    sentAlt: 'The portrait, as it was sent',
    previewSoon: 'A first impression appears here shortly.',
    interrupted: 'The line to the service is interrupted. Trying again.',
    cancel: 'Cancel',
    canceling: 'Canceling',
    remove: 'Delete',
    removeQuestion: 'Delete this job with its pictures and videos?',
    removeYes: 'Delete for good',
    removeNo: 'Keep it',
    result: 'Result',
    driver: 'Performance',
    resultAlt: 'The portrait, acting out the performance',
    driverUnplayable: 'The performance’s video cannot be played here. The result is not affected.',
    download: 'Download video',
    warnings: 'Good to know',
    took: (duration: string) => `Made in ${duration}.`,
    notFound: 'There is no such job',
    notFoundDetail: 'It may have been deleted. Recent jobs are on the start page.',
    canceledDetail: 'This job was stopped before it was done. Nothing of it runs any more.',
    otherKind: 'This page shows portraits. The files of this job can be downloaded here.',
    files: 'All files',
  },

  player: {
    label: 'Result and performance, side by side',
    play: 'Play',
    pause: 'Pause',
    position: 'Position',
    time: (now: string, total: string) => `${now} of ${total}`,
    repeat: 'Repeat',
    sound: 'Sound',
    fullScreen: 'Full screen',
    speed: 'Speed',
    speeds: { 1: 'Normal speed', 0.5: 'Half speed', 0.25: 'Quarter speed' },
  },

  status: {
    queued: 'Waiting',
    running: 'Working',
    succeeded: 'Done',
    failed: 'Failed',
    canceled: 'Canceled',
  } satisfies Record<Status, string>,

  /** Stages by the names that the engine gives them; a new one is shown under its own name. */
  stages: {
    find_face: 'Finding the face',
    separate_layers: 'Separating the person from the background',
    track_driver: 'Watching the performance',
    animate: 'Animating',
  } as Record<string, string>,

  /** What went wrong, by code. The sentence that says what to do comes from the service. */
  failures: {
    no_face: 'No face was found',
    face_too_turned: 'The face is turned too far',
    face_too_small: 'The face is too small',
    no_face_in_driver: 'No face was found in the performance',
    not_an_image: 'That is not a picture',
    image_unreadable: 'The picture cannot be read',
    image_truncated: 'The picture is incomplete',
    image_too_large: 'The picture is too large',
    not_a_video: 'That is not a video',
    no_video_stream: 'The file holds no video',
    video_unreadable: 'The video cannot be read',
    video_too_short: 'The video is too short',
    video_too_long: 'The video is too long',
    video_too_large: 'The video is too large',
    file_empty: 'The file is empty',
    file_too_large: 'The file is too large',
    media_type_unsupported: 'This kind of file is not supported',
    media_type_mismatch: 'The file is not what its name says',
    disk_reserve: 'The disk is full',
    attempts_exhausted: 'This could not be finished',
    unreachable: 'The service does not answer',
    internal_error: 'Something went wrong inside the service',
  } as Record<string, string>,
  failed: 'This did not work',

  /** For answers that bring no sentence of their own. */
  remedies: {
    unreachable: 'Check that `galatea serve` is running and that this machine is connected, then try again.',
    http_413: 'The file is larger than this service accepts. Choose a smaller one.',
    http_507: 'The service’s disk is full. Free some space, then try again.',
  } as Record<string, string>,
  remedy: 'Please try again. If it happens again, the log of the service says more.',
  retry: 'Try again',
} as const;

/** A name from the engine or the library in plain words: `expression_ratios` becomes `Expression ratios`. */
export function plain(name: string): string {
  const words = name.replace(/[_-]+/g, ' ').trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

export const stageName = (stage: string): string => strings.stages[stage] ?? plain(stage);
export const failureTitle = (code: string): string => strings.failures[code] ?? strings.failed;
export const failureRemedy = (code: string, detail: string): string =>
  detail || (strings.remedies[code] ?? strings.remedy);

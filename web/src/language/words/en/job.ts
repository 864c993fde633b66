/** English: a job: its page, what is made of it again, and who may see it. */

import type { Status } from '../../../api';

export const job = {
  job: {
    title: (portrait: string) => portrait,
    back: 'Make another',
    anotherPicture: 'Choose another picture',
    queued: 'Waiting in the queue',
    next: 'Next in the queue',
    place: (number: number) => `Place ${number} in the queue`,
    preparing: 'This happens once and takes a few minutes.',
    starting: 'Starting',
    remaining: (duration: string) => `about ${duration} left`,
    done: (percent: string) => `${percent} done`,
    progress: 'Progress',
    stages: 'Stages',
    stageDone: 'done',
    stageRunning: 'running',
    preview: 'Preview',
    previewAlt: 'A first frame of the result',
    sentAlt: 'The uploaded picture',
    previewSoon: 'A preview appears here shortly.',
    interrupted: 'Connection lost. Reconnecting…',
    cancel: 'Cancel',
    canceling: 'Canceling',
    remove: 'Delete',
    removeQuestion: 'Delete this job with its pictures and videos?',
    removeConfirm: 'Delete permanently',
    result: 'Result',
    driver: 'Performance',
    driverChosen: (name: string) => `Performance: ${name}`,
    driverUnplayable: 'The performance’s video cannot be played here. The result is not affected.',
    download: 'Download video',
    use: 'Use in code',
    useHint: 'The request that makes this result again. Put the files that it names beside it.',
    curl: 'curl',
    python: 'Python',
    embed: 'HTML to show it on a web page',
    warnings: 'Notes',
    took: (duration: string) => `Made in ${duration}.`,
    notFound: 'Job not found',
    notFoundDetail: 'It may have been deleted. Recent jobs are on the start page.',
    canceledDetail: 'This job was canceled before it was done.',
    files: 'All files',
    archive: 'Download all as ZIP',
  },

  redo: {
    title: 'Edit and make again',
    mend: 'Correct and try again',
    asBefore: 'As before',
    send: 'Make it again',
    unchanged: 'No changes yet.',
    versions: 'Versions',
  },

  /** Wherever something is moved or painted over a picture. */
  stage: {
    zoomIn: 'Zoom in',
    zoomOut: 'Zoom out',
    fit: 'Fit to window',
    undo: 'Undo',
    redo: 'Redo',
    reset: 'Start over',
    cancel: 'Cancel',
    done: 'Apply',
  },

  player: {
    label: 'Result and performance',
    inset: 'Performance',
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
    queued: 'Queued',
    running: 'Running',
    succeeded: 'Done',
    failed: 'Failed',
    canceled: 'Canceled',
  } satisfies Record<Status, string>,

  /** Stages that every job may have; those of a kind stand in its folder. Another is shown under its own name. */
  stages: {
    prepare_engine: 'Preparing the engine',
    fetch: 'Downloading the inputs',
  } as Record<string, string>,

  share: {
    title: 'Share',
    hint: 'Anyone with the link can see the result and its title, without a key. Your uploaded picture and video are not shared. Copy a link when it is made: it is shown this once.',
    here: (host: string) =>
      `You are at ${host}: links work on this computer only. To share them, start the service on an address that others can reach.`,
    qr: 'QR code of the link: scan it with a phone',
    term: 'Expires after',
    terms: { day: '1 day', week: '7 days', month: '30 days', open: 'never' },
    everything: 'Include all files',
    create: 'Create link',
    link: 'Link',
    linkOf: (made: string) => `Link of ${made}`,
    earlier: (made: string, hint: string) => `Link of ${made}, which begins with ${hint}`,
    until: (moment: string) => `Expires ${moment}.`,
    untilRevoked: 'Never expires.',
    videoOnly: 'Result only',
    allFiles: 'All files',
    revoke: 'Revoke',
  },

  shared: {
    gone: 'This link does not work',
    goneDetail: 'It has expired, was revoked, or is incomplete. Ask whoever sent it for a new one.',
  },
};

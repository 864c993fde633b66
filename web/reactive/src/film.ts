/** One video element that shows exactly the frames it is asked for. */

/** A file and how fast it runs. */
export interface Strip {
  source: string;
  fps: number;
}

const COUNTS = 'requestVideoFrameCallback' in HTMLVideoElement.prototype; // Firefox: from 132 on

export class Film {
  readonly video = document.createElement('video');
  /** The file that is in it. */
  source = '';
  /** The frame that was shown last. */
  frame = 0;
  private fps = 30;
  private loaded: Promise<void> = Promise.resolve();
  private shown: ((frame: number) => void) | null = null;
  private waiting = 0;
  private cues = 0;

  constructor() {
    const { video } = this;
    video.muted = video.defaultMuted = true; // else browsers do not let it play unasked
    video.playsInline = true;
    video.disableRemotePlayback = true;
    video.preload = 'auto';
    video.tabIndex = -1;
    video.setAttribute('aria-hidden', 'true');
  }

  /** Stand still at a frame of a file. Resolves when that frame can be drawn; false if another cue came meanwhile. */
  async cue({ source, fps }: Strip, frame: number): Promise<boolean> {
    const mine = ++this.cues;
    this.halt();
    const { video } = this;
    if (this.source !== source) {
      this.source = source;
      video.src = source;
      this.loaded = until(video, 'loadeddata', () => video.readyState >= 2);
    }
    await this.loaded;
    if (mine !== this.cues) return false;
    this.fps = fps;
    this.frame = frame;
    // the middle of the frame: its edges are a matter of rounding
    const moment = (frame + 0.5) / fps;
    if (Math.abs(video.currentTime - moment) > 0.4 / fps) {
      video.currentTime = moment;
      await until(video, 'seeked', () => !video.seeking);
    }
    return mine === this.cues;
  }

  /** From now on `shown` hears of every frame that comes up. */
  watch(shown: (frame: number) => void): void {
    this.shown = shown;
    this.listen();
  }

  /** Whether anybody hears of its frames. */
  get watched(): boolean {
    return this.shown !== null;
  }

  /** Stand still, and be silent about it. */
  halt(): void {
    this.shown = null;
    this.video.pause();
  }

  /** Give back what it holds. */
  release(): void {
    this.cues++;
    this.halt();
    this.source = '';
    this.video.removeAttribute('src');
    this.video.load();
  }

  private listen(): void {
    const mine = ++this.waiting;
    const show = (seconds: number): void => {
      if (!this.shown || mine !== this.waiting) return;
      this.listen();
      const frame = Math.floor(seconds * this.fps + 0.1);
      this.frame = frame;
      this.shown(frame);
    };
    if (COUNTS) this.video.requestVideoFrameCallback((_, { mediaTime }) => show(mediaTime));
    else requestAnimationFrame(() => show(this.video.currentTime));
  }
}

/** Wait for an event after which something holds. */
function until(video: HTMLVideoElement, event: string, holds: () => boolean): Promise<void> {
  return new Promise((resolve, reject) => {
    const ended = new AbortController();
    const { signal } = ended;
    const check = (): void => {
      if (!holds()) return;
      ended.abort();
      resolve();
    };
    const fail = (): void => {
      ended.abort();
      reject(new Error(video.error?.message || 'the video cannot be played'));
    };
    video.addEventListener(event, check, { signal });
    video.addEventListener('error', fail, { signal });
    check();
  });
}

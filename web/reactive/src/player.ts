/**
 * What is shown when: the idle clip again and again, a state's clip when it is asked for, and a bridge between them. A
 * bridge leads from the very frame that is shown to rest, where every clip begins.
 *
 * All is drawn on one canvas, so that going over from one video to the next shows neither a gap nor a mixture.
 */

import { Files } from './files';
import { Film, type Strip } from './film';
import type { Profile, TransitionPart } from './profile';

/** A frame that has come up: of a state's clip, or of the bridge that leads away from it. */
export interface Shown {
  state: string;
  part: 'clip' | 'bridge';
  frame: number;
}

/** Who is told. */
export interface Audience {
  frame(shown: Shown): void;
  /** A clip has ended, and another state has begun of itself. */
  ended(state: string, previous: string): void;
  failed(error: unknown): void;
}

interface Scene {
  film: Film;
  state: string;
  part: 'clip' | 'bridge';
}

const HOLD = 2; // frames of rest that follow each bridge
const REST: TransitionPart = { end: '', segments: [], at: [] };

export class Player {
  /** The state that is shown, or led to. */
  state: string;
  private readonly files: Files;
  private readonly canvas: CanvasRenderingContext2D;
  private readonly films = [new Film(), new Film(), new Film(), new Film()];
  /** What is on; null at rest. */
  private scene: Scene | null = null;
  /** What follows of itself, and what was asked for: each ready when its first frame can be drawn. */
  private next: Promise<Film> | null = null;
  private asked: Promise<Film> | null = null;
  /** The film that bridges are in. */
  private bridge: Film | null = null;
  private held = false;
  /** How often something was asked for. */
  private wishes = 0;

  constructor(
    private readonly profile: Profile,
    base: URL,
    canvas: HTMLCanvasElement,
    private readonly idles: boolean,
    private readonly audience: Audience,
    private readonly signal: AbortSignal,
  ) {
    this.state = profile.initial;
    this.files = new Files(base, signal);
    [canvas.width, canvas.height] = profile.size;
    this.canvas = canvas.getContext('2d', { alpha: false })!;
    for (const film of this.films) film.video.addEventListener('ended', () => this.ended(film), { signal });
    canvas.before(...this.films.map((film) => film.video));
    signal.addEventListener('abort', () => this.release());
  }

  /** Begin to idle, where that is wanted, and load all the rest meanwhile. */
  async start(): Promise<void> {
    const { initial, states, transitions } = this.profile;
    if (this.idles) {
      const film = await this.cue(initial);
      if (this.wishes === 0) this.begin(film, initial); // else somebody was quicker
    }
    for (const name of [initial, ...Object.keys(states)]) {
      await this.files.get(states[name]!.clip);
      const { bridges } = transitions[name]!;
      if (bridges) await this.files.get(bridges);
    }
  }

  /** Go over to a state; at once, if its files are there. */
  go(state: string): void {
    if (!(state in this.profile.states)) throw new RangeError(`the profile has no state ${state}`);
    if (state === this.state && this.scene) return;
    this.state = state;
    this.leave(state).catch((error: unknown) => this.fail(error));
  }

  /** Stand still where it is, for as long as `held`. */
  hold(held: boolean): void {
    if (held === this.held) return;
    this.held = held;
    const video = this.scene?.film.video;
    if (held) video?.pause();
    else if (video && this.scene!.film.watched) this.roll(this.scene!.film);
  }

  private async leave(state: string): Promise<void> {
    const wish = ++this.wishes;
    const clip = this.profile.states[state]!.clip;
    let from: string | undefined;
    do {
      // what is on goes on until all is there that leads away from it
      from = this.scene?.state;
      const bridges = from === undefined ? null : this.profile.transitions[from]!.bridges;
      await Promise.all([this.files.get(clip), bridges && this.files.get(bridges)]);
    } while (this.scene?.state !== from);
    if (this.wishes !== wish) return; // asked for something else meanwhile
    const { scene } = this;
    if (scene?.part === 'bridge') return this.ask(state); // it leads on to what is asked for when it ends
    scene?.film.halt();
    const { at, segments, bridges } = scene ? this.profile.transitions[scene.state]! : REST;
    const segment = segments[at[scene?.film.frame ?? 0] ?? -1];
    if (scene && segment && bridges) {
      scene.part = 'bridge'; // from now on a further wish waits for its end
      return this.cross(scene, await this.files.get(bridges), segment);
    }
    this.ask(state);
    await this.arrive();
  }

  private ask(state: string): void {
    this.asked = this.cue(state);
  }

  /** Show a bridge, from the frame on that stands still, and then what was asked for. */
  private async cross(scene: Scene, source: string, [start, length]: [number, number]): Promise<void> {
    const film = (this.bridge = this.free(source));
    const ready = film.cue(this.strip(source), start);
    this.ask(this.state);
    if (!(await ready)) return;
    scene.film = film;
    this.show(start);
    film.watch((frame) => {
      if (frame < start + length + HOLD) this.show(frame);
      if (frame >= start + length) this.ended(film);
    });
    this.roll(film);
  }

  /** At rest: begin what was asked for last. */
  private async arrive(): Promise<void> {
    let film: Film;
    let asked: Promise<Film> | null;
    do {
      asked = this.asked;
      if (!asked) return; // it has begun already
      film = await asked;
    } while (asked !== this.asked);
    this.begin(film, this.state);
  }

  private begin(film: Film, state: string): void {
    this.scene = { film, state, part: 'clip' };
    this.next = this.asked = null;
    if (this.bridge === film) this.bridge = null;
    this.show(0);
    film.watch((frame) => {
      this.show(frame);
      const { frames, loops } = this.profile.states[state]!;
      if (frame >= frames - 1 && !loops) this.ended(film);
    });
    this.roll(film);
    this.prepare(state).catch((error: unknown) => this.fail(error));
  }

  /** Make ready what follows of itself, and the bridges that may be needed before. */
  private async prepare(state: string): Promise<void> {
    const scene = this.scene;
    const { end, bridges } = this.profile.transitions[state]!;
    await this.files.get(this.profile.states[end]!.clip);
    if (this.asked || this.scene !== scene) return;
    const next = (this.next = this.cue(end));
    const source = bridges && (await this.files.get(bridges));
    const film = await next;
    if (!source || this.asked || this.scene !== scene) return;
    this.bridge = this.free(source, film);
    await this.bridge.cue(this.strip(source), 0);
  }

  /** The film on show has come to its end. */
  private ended(film: Film): void {
    const { scene } = this;
    if (scene?.film !== film || !film.watched) return;
    film.halt();
    if (scene.part === 'bridge') return void this.arrive().catch((error: unknown) => this.fail(error));
    const end = this.profile.transitions[scene.state]!.end;
    if (this.state === scene.state && end !== this.state) {
      this.state = end;
      this.audience.ended(end, scene.state);
    }
    if (!this.idles && this.state === this.profile.initial) {
      this.scene = null;
      return;
    }
    const next = (this.next ??= this.cue(end));
    next.then(
      (ready) => {
        if (this.scene === scene && scene.part === 'clip') this.begin(ready, end);
      },
      (error: unknown) => this.fail(error),
    );
  }

  /** A film that stands at the first frame of a state's clip. */
  private async cue(state: string): Promise<Film> {
    const source = await this.files.get(this.profile.states[state]!.clip);
    const film = this.free(source, this.bridge);
    await film.cue(this.strip(source), 0);
    return film;
  }

  /** A film that is not on show: the one that holds the file, if there is one. */
  private free(source: string, but: Film | null = null): Film {
    const free = this.films.filter((film) => film !== this.scene?.film);
    return free.find((film) => film.source === source) ?? free.find((film) => film !== but)!;
  }

  private strip(source: string): Strip {
    return { source, fps: this.profile.fps };
  }

  private show(frame: number): void {
    const { film, state, part } = this.scene!;
    const [width, height] = this.profile.size;
    this.canvas.drawImage(film.video, 0, 0, width, height);
    this.audience.frame({ state, part, frame });
  }

  private roll(film: Film): void {
    if (this.held) return;
    film.video.play().catch((error: unknown) => {
      // paused before it began, or not allowed to play unasked: then the picture stands still until it may
      if (!(error instanceof DOMException && /Abort|NotAllowed/.test(error.name))) this.fail(error);
    });
  }

  private fail(error: unknown): void {
    if (!this.signal.aborted) this.audience.failed(error);
  }

  private release(): void {
    this.scene = null;
    for (const film of this.films) {
      film.release();
      film.video.remove();
    }
    this.files.release();
  }
}

/** `<reactive-portrait src="profile.json">`. */

import { Player, type Shown } from './player';
import { loadProfile, parseTriggers, type Profile, type Trigger } from './profile';
import { type Cause, listen } from './triggers';

/** What `statechange` tells in its `detail`. */
export interface StateChange {
  state: string;
  previous: string;
  cause: Cause;
}

const style = new CSSStyleSheet();
style.replaceSync(`
:host { display: inline-block; position: relative; overflow: hidden; vertical-align: bottom; max-width: 100%; cursor: default }
:host([hidden]) { display: none }
:host(:focus-visible) { outline: 3px solid Highlight; outline-offset: 2px }
canvas, img, video, ::slotted(*) { position: absolute; inset: 0; width: 100% !important; height: 100% !important;
  object-fit: var(--reactive-portrait-fit, cover); pointer-events: none }
[hidden] { display: none }
`);

export class ReactivePortrait extends HTMLElement {
  static readonly observedAttributes = ['src', 'poster', 'alt', 'width', 'height', 'triggers', 'motion', 'paused'];

  /** Hears of every frame as it is shown: for captions, sounds, measurements. */
  onframe: ((shown: Shown) => void) | null = null;

  private readonly size = new CSSStyleSheet();
  private readonly still = document.createElement('img');
  private readonly calm = matchMedia('(prefers-reduced-motion: reduce)');
  private profile: Profile | null = null;
  private player: Player | null = null;
  private running = new AbortController();
  private listening = new AbortController();
  private begun: Player | null = null;
  private near = false;
  private queued = false;

  constructor() {
    super();
    const shadow = this.attachShadow({ mode: 'open' });
    shadow.adoptedStyleSheets = [style, this.size];
    this.still.alt = '';
    this.still.hidden = true;
    shadow.append(document.createElement('slot'), this.still);
  }

  /** The address of the profile's `profile.json`. */
  get src(): string {
    return this.getAttribute('src') ?? '';
  }
  set src(value: string) {
    this.setAttribute('src', value);
  }

  /** The state that is shown, or led to; empty until the profile is loaded. */
  get state(): string {
    return this.player?.state ?? this.profile?.initial ?? '';
  }

  /** What `play` takes; empty until the profile is loaded. */
  get states(): readonly string[] {
    return Object.keys(this.profile?.states ?? {});
  }

  /** Whether it stands still. */
  get paused(): boolean {
    return this.hasAttribute('paused');
  }
  set paused(value: boolean) {
    this.toggleAttribute('paused', value);
  }

  /** Go over to a state. Throws `RangeError` if the profile has none of that name. */
  play(state: string): void {
    if (this.profile && !(state in this.profile.states)) throw new RangeError(`the profile has no state ${state}`);
    this.go(state, 'script');
  }

  protected connectedCallback(): void {
    this.restart();
  }

  protected disconnectedCallback(): void {
    this.stop();
  }

  protected attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    if (!this.isConnected || before === after) return;
    if (name === 'paused') this.attend();
    else if (name === 'triggers') this.hear();
    else if (name === 'src' || name === 'motion') this.restart();
    else this.dress();
  }

  private stop(): void {
    this.running.abort();
    this.listening.abort();
    this.player = this.profile = null;
    this.near = false;
    this.shadowRoot!.querySelector('canvas')?.remove();
  }

  /** Load the profile anew, once for all attributes that are set at a time. */
  private restart(): void {
    if (this.queued) return;
    this.queued = true;
    queueMicrotask(() => {
      this.queued = false;
      this.stop();
      if (!this.isConnected) return;
      this.running = new AbortController();
      const { signal } = this.running;
      this.dress();
      this.calm.addEventListener('change', () => this.restart(), { signal });
      document.addEventListener('visibilitychange', () => this.attend(), { signal });
      if (this.src) this.load(signal).catch((error: unknown) => this.fail(error, signal));
    });
  }

  private async load(signal: AbortSignal): Promise<void> {
    const address = new URL(this.src, document.baseURI);
    const profile = await loadProfile(address, signal);
    signal.throwIfAborted();
    this.profile = profile;
    if (!this.hasAttribute('poster')) this.still.src = new URL(profile.poster, address).href;
    this.dress();
    const canvas = document.createElement('canvas');
    canvas.hidden = true;
    this.still.after(canvas);
    const audience = {
      frame: (shown: Shown): void => {
        canvas.hidden = false;
        this.onframe?.(shown);
      },
      ended: (state: string, previous: string): void => this.tell(state, 'end', previous),
      failed: (error: unknown): void => this.fail(error, signal),
    };
    this.player = new Player(profile, address, canvas, this.moves, audience, signal);
    this.hear();
    const observer = new IntersectionObserver(
      (entries) => {
        this.near = entries.at(-1)!.isIntersecting; // a page that is slow hears of several changes at once
        this.attend();
      },
      { rootMargin: '50px' },
    );
    observer.observe(this);
    signal.addEventListener('abort', () => observer.disconnect());
    this.dispatchEvent(new Event('load'));
  }

  /** Whether it may move unasked. */
  private get moves(): boolean {
    return !this.calm.matches || this.getAttribute('motion') === 'always';
  }

  /** Move when it can be seen, and stand still when not. */
  private attend(): void {
    const { player } = this;
    if (!player) return;
    const seen = this.near && !document.hidden;
    player.hold(!seen || this.paused);
    if (!seen || this.begun === player) return;
    this.begun = player;
    const { signal } = this.running;
    player.start().catch((error: unknown) => this.fail(error, signal));
  }

  private hear(): void {
    this.listening.abort();
    if (!this.profile) return;
    this.listening = new AbortController();
    const given = this.getAttribute('triggers');
    const triggers: Trigger[] = given === null ? this.profile.triggers : parseTriggers(given);
    const known = triggers.filter(({ state }) => state in this.profile!.states);
    const clicks = known.some(({ on }) => on === 'click' || on === 'key');
    if (clicks && !this.hasAttribute('tabindex')) this.tabIndex = 0;
    if (!this.hasAttribute('role')) this.setAttribute('role', clicks ? 'button' : 'img');
    listen(this, known, !this.moves, (state, cause) => this.go(state, cause), this.listening.signal);
  }

  private go(state: string, cause: Cause): void {
    const { player } = this;
    if (!player || (this.paused && cause !== 'script')) return;
    const previous = player.state;
    player.go(state);
    if (player.state !== previous) this.tell(state, cause, previous);
  }

  private tell(state: string, cause: Cause, previous: string): void {
    this.dispatchEvent(new CustomEvent<StateChange>('statechange', { detail: { state, previous, cause } }));
  }

  private fail(error: unknown, signal: AbortSignal): void {
    if (signal.aborted) return;
    this.dispatchEvent(new ErrorEvent('error', { error, message: error instanceof Error ? error.message : String(error) }));
  }

  /** Size, name and picture: what can be known before anything is loaded. */
  private dress(): void {
    const [width, height] = this.profile?.size ?? [Number(this.getAttribute('width')), Number(this.getAttribute('height'))];
    const wide = this.getAttribute('width') ?? width;
    const ratio = this.hasAttribute('width') && this.hasAttribute('height')
      ? `${this.getAttribute('width')} / ${this.getAttribute('height')}` : `${width} / ${height}`;
    this.size.replaceSync(Number(width) > 0 ? `:host { width: ${Number(wide)}px; aspect-ratio: ${ratio} }` : '');
    const poster = this.getAttribute('poster');
    if (poster !== null) this.still.src = poster;
    this.still.hidden = !this.still.src;
    this.setAttribute('aria-label', this.getAttribute('alt') ?? 'Portrait');
  }
}

declare global {
  interface HTMLElementTagNameMap {
    'reactive-portrait': ReactivePortrait;
  }
}

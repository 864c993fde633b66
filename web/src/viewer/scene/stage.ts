/** Where things are seen: a canvas with a camera that circles, drawn anew only when something has changed. */

import { Box3, Color, PerspectiveCamera, Scene, Spherical, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

/** Degrees, from top to bottom. */
const FIELD = 32;
/** Sharper than this costs more than it shows. */
const SHARPEST = 2;
/** Seconds: a page that was asleep goes on where it was. */
const LONGEST_STEP = 0.1;
/** Radians, and the share of the distance, for each press of a key. */
const TURN = Math.PI / 24;
const STEP = 0.9;

/** No WebGL here: nothing can be shown in 3D. */
export class NoWebGL extends Error {}

export interface Performer {
  /** Go on by some seconds; whether there is more to come. */
  advance?(seconds: number): boolean;
  /** Something to be drawn before the scene itself. */
  prepare?(renderer: WebGLRenderer): void;
}

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(FIELD, 1, 0.05, 60);
  readonly renderer: WebGLRenderer;
  readonly controls: OrbitControls;
  private readonly performers = new Set<Performer>();
  private readonly watching = new AbortController();
  private readonly sizes: ResizeObserver;
  private readonly sight: IntersectionObserver;
  private frameRequest = 0;
  private before = 0;
  private visible = true;
  private goesOn = false;
  private held = false;

  /** Raises `NoWebGL` where the browser has none. */
  constructor(readonly place: HTMLElement) {
    const canvas = document.createElement('canvas');
    const context = canvas.getContext('webgl2', { antialias: true, alpha: false, powerPreference: 'high-performance' });
    if (!context) throw new NoWebGL();
    this.renderer = new WebGLRenderer({ canvas, context });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, SHARPEST));
    place.append(canvas);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false; // it would go on drawing after the hand is off
    this.controls.addEventListener('change', () => this.invalidate());
    this.sizes = new ResizeObserver(() => this.fit());
    this.sizes.observe(place);
    this.sight = new IntersectionObserver((entries) => {
      this.visible = entries.at(-1)!.isIntersecting; // a page that is slow hears of several changes at once
      if (this.visible) this.invalidate();
    });
    this.sight.observe(place);
    const { signal } = this.watching;
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault(), { signal }); // it may come back
    canvas.addEventListener('webglcontextrestored', () => this.invalidate(), { signal });
    place.addEventListener('keydown', (event) => this.key(event), { signal });
    this.fit();
  }

  /** Draw once more, as soon as the screen is ready. */
  invalidate(): void {
    if (this.frameRequest || this.held || !this.visible || this.renderer.xr.isPresenting || this.watching.signal.aborted) return;
    this.frameRequest = requestAnimationFrame((now) => {
      this.frameRequest = 0;
      this.draw(now);
      if (this.goesOn) this.invalidate();
    });
  }

  /** Stand still while something else has the visitor's eyes. */
  hold(held: boolean): void {
    this.held = held;
    this.invalidate();
  }

  /** Draw now; all that moves goes on by the time since the last drawing. */
  draw(now: number): void {
    const seconds = this.goesOn ? Math.min((now - this.before) / 1000, LONGEST_STEP) : 0;
    this.before = now;
    this.goesOn = false;
    for (const performer of this.performers) if (performer.advance?.(seconds)) this.goesOn = true;
    for (const performer of this.performers) performer.prepare?.(this.renderer);
    this.renderer.render(this.scene, this.camera);
  }

  /** Somebody takes part from now on; call the answer to let them go. */
  add(performer: Performer): () => void {
    this.performers.add(performer);
    this.invalidate();
    return () => {
      this.performers.delete(performer);
      this.invalidate();
    };
  }

  paint(background: string): void {
    this.scene.background = new Color(background);
    this.invalidate();
  }

  /** Look at a box from the front, so that all of it is seen. */
  frame(box: Box3): void {
    const [middle, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3())];
    this.camera.fov = FIELD;
    this.camera.updateProjectionMatrix();
    const half = Math.tan((FIELD * Math.PI) / 360);
    const distance = Math.max(size.y, size.x / this.camera.aspect) / 2 / half;
    this.look(new Vector3(middle.x, middle.y, box.max.z + distance), middle);
  }

  look(from: Vector3, at: Vector3): void {
    this.controls.target.copy(at);
    this.camera.position.copy(from);
    this.controls.update();
    this.invalidate();
  }

  dispose(): void {
    this.watching.abort();
    cancelAnimationFrame(this.frameRequest);
    this.sizes.disconnect();
    this.sight.disconnect();
    this.controls.dispose();
    this.renderer.setAnimationLoop(null);
    this.renderer.dispose();
    this.renderer.forceContextLoss(); // browsers grant few contexts: give this one back now
    this.renderer.domElement.remove();
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (!width || !height || this.renderer.xr.isPresenting) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    cancelAnimationFrame(this.frameRequest); // a canvas of a new size is empty: fill it before it is seen
    this.frameRequest = 0;
    this.draw(performance.now());
    if (this.goesOn) this.invalidate();
  }

  private key(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey || event.target !== this.place) return;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.circle(-TURN, 0, 1),
      ArrowRight: () => this.circle(TURN, 0, 1),
      ArrowUp: () => this.circle(0, -TURN, 1),
      ArrowDown: () => this.circle(0, TURN, 1),
      '+': () => this.circle(0, 0, STEP),
      '=': () => this.circle(0, 0, STEP),
      '-': () => this.circle(0, 0, 1 / STEP),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  private circle(around: number, over: number, nearer: number): void {
    const { target, minAzimuthAngle, maxAzimuthAngle, minPolarAngle, maxPolarAngle } = this.controls;
    const place = new Spherical().setFromVector3(this.camera.position.clone().sub(target));
    place.theta = clamped(place.theta + around, minAzimuthAngle, maxAzimuthAngle);
    place.phi = clamped(place.phi + over, Math.max(0.01, minPolarAngle), Math.min(Math.PI - 0.01, maxPolarAngle));
    place.radius = clamped(place.radius * nearer, this.controls.minDistance, this.controls.maxDistance);
    this.look(new Vector3().setFromSpherical(place).add(target), target);
  }
}

const clamped = (value: number, min: number, max: number): number => Math.min(max, Math.max(min, value));

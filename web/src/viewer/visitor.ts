/** Somebody who looks at a picture on a wall, and steps back for whoever comes out of it; until the visitor goes their own way. */

import { MathUtils, Vector3 } from 'three';
import type { Hanging } from './hanging';
import type { Performer, Stage } from './stage';
import type { Stepping } from './stepping';

/** Share of the view that the picture takes at first, and the person at last. */
const FILLS = 0.75;
/** Metres: more than people are tall. */
const PERSON = 1.9;

export class Visitor implements Performer {
  private readonly stop = new AbortController();
  private led = true;
  private way = -1;
  private readonly heed = (): void => {
    this.led = false;
  };

  constructor(
    private readonly stage: Stage,
    private readonly hanging: Hanging,
    private readonly stepping: Stepping,
  ) {
    stage.controls.addEventListener('start', this.heed);
    stage.place.addEventListener('keydown', ({ key }) => key.startsWith('Arrow') && this.heed(), { signal: this.stop.signal });
  }

  advance(): boolean {
    const { way } = this.stepping;
    if (!this.led || way === this.way || this.stage.renderer.xr.isPresenting) return false;
    this.way = way;
    const [first, last] = [this.before(), this.after()];
    const share = MathUtils.smoothstep(way, 0, 0.8);
    this.stage.look(first.from.lerp(last.from, share), first.at.lerp(last.at, share));
    return false;
  }

  comeBack(): void {
    this.led = true;
    this.way = -1;
    this.stage.invalidate();
  }

  dispose(): void {
    this.stage.controls.removeEventListener('start', this.heed);
    this.stop.abort();
  }

  /** As far off as it takes to see all of the picture. */
  private before() {
    const { left, right, top, bottom, plane } = this.hanging;
    const at = new Vector3((left + right) / 2, (top + bottom) / 2, plane);
    return { at, from: at.clone().setZ(plane + this.distance(right - left, top - bottom)) };
  }

  /** As far off as it takes to see everybody at the end of the way. */
  private after() {
    const { ends } = this.stepping;
    const [xs, zs] = [ends.map(({ x }) => x), ends.map(({ z }) => z)];
    const [left, right] = [Math.min(...xs) - PERSON / 4, Math.max(...xs) + PERSON / 4];
    const nearest = Math.max(...zs);
    const before = this.before();
    const at = new Vector3((left + right) / 2, PERSON / 2, nearest);
    return { at, from: at.clone().setZ(Math.max(before.from.z, nearest + this.distance(right - left, PERSON))) };
  }

  private distance(width: number, height: number): number {
    const { fov, aspect } = this.stage.camera;
    return Math.max(height, width / aspect) / FILLS / 2 / Math.tan((fov * Math.PI) / 360);
  }
}

/** Somebody who looks at a picture on a wall, and steps back for whoever comes out of it; until the visitor goes their own way. */

import { MathUtils } from 'three';
import type { Hanging } from './hanging';
import type { Performer, Stage } from '../scene/stage';
import type { StepOut } from './step_out';
import { pictureView, roomView } from './viewpoint';

/** Share of their way at which the visitor has stepped back: before them, or their feet would leave the view. */
const STEPPED_BACK = 0.5;

export class VisitorCamera implements Performer {
  private readonly stop = new AbortController();
  private led = true;
  private way = -1;
  private readonly heed = (): void => {
    this.led = false;
  };

  constructor(
    private readonly stage: Stage,
    private readonly hanging: Hanging,
    private readonly stepOut: StepOut,
  ) {
    stage.controls.addEventListener('start', this.heed);
    stage.place.addEventListener('keydown', ({ key }) => key.startsWith('Arrow') && this.heed(), { signal: this.stop.signal });
  }

  advance(): boolean {
    const { way } = this.stepOut;
    if (!this.led || way === this.way || this.stage.renderer.xr.isPresenting) return false;
    this.way = way;
    const { camera } = this.stage;
    const [first, last] = [pictureView(this.hanging, camera), roomView(this.hanging, this.stepOut.ends, camera)];
    const share = MathUtils.smoothstep(way, 0, STEPPED_BACK);
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
}

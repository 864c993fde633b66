/** What reactive.test.ts leaves on the page that it opens. */

import type { ReactivePortrait, StateChange } from '../../../web/reactive/src/element';

declare global {
  interface HTMLElementTagNameMap {
    'reactive-portrait': ReactivePortrait;
  }
  interface HTMLElementEventMap {
    statechange: CustomEvent<StateChange>;
  }
  interface Window {
    seen: { at: number; state: string; part: 'clip' | 'bridge'; frame: number; change: number; energy: number }[];
    changes: ({ at: number } & StateChange)[];
    shifts: PerformanceEntry[];
  }
  const seen: Window['seen'];
  const changes: Window['changes'];
  const shifts: PerformanceEntry[];
  let look: boolean;
  const axe: { run(): Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> };
}

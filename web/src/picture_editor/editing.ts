/** What is edited over a picture: its state with the way back, the part of the picture that is seen, and the keys. */

import { useReducer, useState } from 'preact/hooks';
import { begun, type History, step, type Step } from './history';
import type { Point } from './geometry';
import { historyKey } from './tools';
import { type View, whole, zoomed } from './view';

export interface Editing<State> {
  history: History<State>;
  advance: (next: Step<State>) => void;
  state: State;
  /** Another state, which is undone by itself. */
  change: (state: State) => void;
  view: View;
  setView: (view: View) => void;
  /** Nearer to a place by a factor; null shows the whole picture. */
  zoom: (factor: number | null, to: Point) => void;
}

/** `first`: what is seen to begin with, where that is not the whole picture. */
export function useEditing<State>(
  size: readonly [width: number, height: number],
  start: State,
  first?: (picture: View) => View,
): Editing<State> {
  const picture = whole(...size);
  const [history, advance] = useReducer(step<State>, start, begun<State>);
  const [view, setView] = useState<View>(() => first?.(picture) ?? picture);
  return {
    ...{ history, advance, state: history.state, view, setView },
    change: (state) => {
      advance({ type: 'begin' });
      advance({ type: 'change', state });
    },
    zoom: (factor, to) => setView(factor === null ? picture : zoomed(view, factor, to, picture)),
  };
}

type Actions = Record<string, () => void>;

/** What the four arrows do. */
export const arrows = (unit: number, go: (dx: number, dy: number) => void): Actions => ({
  arrowleft: () => go(-unit, 0),
  arrowright: () => go(unit, 0),
  arrowup: () => go(0, -unit),
  arrowdown: () => go(0, unit),
});

/** What plus and minus do where they bring the picture nearer. */
export const zoomKeys = (zoom: (factor: number) => void): Actions => ({
  '+': () => zoom(1.5),
  '=': () => zoom(1.5),
  '-': () => zoom(1 / 1.5),
});

/** Do what a key says, by its name in small letters; with Ctrl or Command, go back or on. */
export function act<State>(event: KeyboardEvent, actions: Actions, advance: (next: Step<State>) => void): void {
  const command = event.ctrlKey || event.metaKey;
  const action = command ? historyKey(event, advance) : actions[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  action();
}

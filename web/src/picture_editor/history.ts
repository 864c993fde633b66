/** What is edited as it is, as it was, and as it would be again. */

export interface History<State> {
  past: readonly State[];
  state: State;
  future: readonly State[];
}

export type Step<State> =
  /** A gesture begins: what it changes is undone as one. */
  | { type: 'begin' }
  | { type: 'change'; state: State }
  | { type: 'undo' }
  | { type: 'redo' };

export const begun = <State,>(state: State): History<State> => ({ past: [], state, future: [] });

export function step<State>(history: History<State>, next: Step<State>): History<State> {
  const { past, state, future } = history;
  switch (next.type) {
    case 'begin':
      return { past: past.at(-1) === state ? past : [...past, state], state, future };
    case 'change':
      return { past, state: next.state, future: [] };
    case 'undo': {
      const earlier = past.at(-1);
      if (earlier === undefined) return history;
      // a gesture that changed nothing leaves no step behind
      if (earlier === state) return step({ past: past.slice(0, -1), state, future }, { type: 'undo' });
      return { past: past.slice(0, -1), state: earlier, future: [state, ...future] };
    }
    case 'redo': {
      const later = future[0];
      return later === undefined ? history : { past: [...past, state], state: later, future: future.slice(1) };
    }
  }
}

export const canUndo = <State,>({ past, state }: History<State>): boolean =>
  past.some((earlier) => earlier !== state);
export const canRedo = <State,>({ future }: History<State>): boolean => future.length > 0;

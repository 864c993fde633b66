/** What sets states off, on the page. */

import type { Trigger } from './profile';

/** What set a state off: a trigger, a call of `play`, or the end of the state before. */
export type Cause = Trigger['on'] | 'script' | 'end';

/** Hear of triggers until the signal. `still`: only of what is done on purpose, a click or a key. */
export function listen(
  host: HTMLElement,
  triggers: readonly Trigger[],
  still: boolean,
  act: (state: string, cause: Cause) => void,
  signal: AbortSignal,
): void {
  const of = (on: Trigger['on']): Trigger | undefined => triggers.find((one) => one.on === on);
  const on = (target: EventTarget, name: string, handle: (event: never) => void): void =>
    target.addEventListener(name, handle as EventListener, { signal });
  const [hover, click, view] = [of('hover'), of('click'), of('view')];

  if (hover && !still) {
    on(host, 'pointerenter', (event: PointerEvent) => event.pointerType !== 'touch' && act(hover.state, 'hover'));
    on(host, 'focus', () => host.matches(':focus-visible') && act(hover.state, 'hover'));
  }
  if (click) on(host, 'click', () => act(click.state, 'click'));
  on(document, 'keydown', (event: KeyboardEvent) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const focused = host.matches(':focus');
    if (focused && click && (event.key === 'Enter' || event.key === ' ')) {
      event.preventDefault(); // the page would scroll
      if (!event.repeat) act(click.state, 'key');
      return;
    }
    const found = triggers.find((one) => one.on === 'key' && one.key === event.key);
    if (found && !writes(event) && (focused || host.matches(':hover'))) act(found.state, 'key');
  });
  if (view && !still) {
    const observer = new IntersectionObserver(
      (entries) => entries.at(-1)!.isIntersecting && act(view.state, 'view'), // of several at once the last is true now
      { threshold: 0.6 },
    );
    observer.observe(host);
    signal.addEventListener('abort', () => observer.disconnect());
  }
}

/** Whether somebody writes into something. */
function writes(event: KeyboardEvent): boolean {
  const target = event.composedPath()[0];
  return target instanceof HTMLElement && (target.isContentEditable || target.matches('input, textarea, select'));
}

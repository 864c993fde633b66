/** A picture to work on: wheel and pinch bring it nearer, what is taken hold of is dragged, and the picture elsewhere. */

import type { ComponentChildren } from 'preact';
import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import type { Point } from './geometry';
import { kept, panned, type View, whole, zoomed } from './view';

/** How near, in pixels of the screen, a finger or pointer has to come. */
const REACH = { mouse: 18, pen: 22, touch: 30 } as Record<string, number>;

/** Where a pointer came down. */
export interface Touch {
  at: Point;
  /** How far around it things are within reach, in pixels of the picture. */
  reach: number;
  /** On which half of the stage. */
  side: 'left' | 'right';
}

/** What a pointer that came down does until it is lifted. */
export interface Drag {
  move: (at: Point, side: 'left' | 'right') => void;
  end?: () => void;
  /** A second finger came down: it was no drag. */
  cancel?: () => void;
}

interface Props {
  size: readonly [width: number, height: number];
  view: View;
  label: string;
  help: string;
  class?: string;
  /** Whether what is drawn can be reached by the keyboard, piece by piece. */
  reachable?: boolean;
  /** Null leaves the drag to the picture itself. */
  onGrasp: (touch: Touch) => Drag | null;
  /** Where a pointer is that is not down; null where there is none. */
  onHover?: (at: Point | null) => void;
  onView: (view: View) => void;
  onScale?: (scale: number) => void;
  onKey: (event: KeyboardEvent) => void;
  /** Drawn in pixels of the picture. */
  children: ComponentChildren;
  /** Laid over the stage. */
  over?: ComponentChildren;
}

interface Place {
  clientX: number;
  clientY: number;
}

export function Surface(props: Props) {
  const { size, view } = props;
  const picture = whole(...size);
  const svg = useRef<SVGSVGElement>(null);
  const pointers = useRef(new Map<number, Place>());
  const drag = useRef<Drag | null>(null);
  const panFrom = useRef<Point | null>(null);

  const place = (event: Place): Point => {
    const matrix = svg.current?.getScreenCTM()?.inverse();
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix ?? undefined);
    return [x, y];
  };
  const sideOf = (event: Place): 'left' | 'right' => {
    const bounds = svg.current?.getBoundingClientRect();
    return bounds && event.clientX < bounds.left + bounds.width / 2 ? 'left' : 'right';
  };

  const down = (event: PointerEvent): void => {
    if (event.button > 0) return;
    svg.current?.setPointerCapture(event.pointerId);
    pointers.current.set(event.pointerId, { clientX: event.clientX, clientY: event.clientY });
    const at = place(event);
    if (pointers.current.size > 1) {
      drag.current?.cancel?.();
      drag.current = null;
      panFrom.current = at;
      return;
    }
    const scale = svg.current?.getScreenCTM()?.a || 1;
    drag.current = props.onGrasp({ at, reach: (REACH[event.pointerType] ?? 18) / scale, side: sideOf(event) });
    panFrom.current = drag.current ? null : at;
  };
  const move = (event: PointerEvent): void => {
    const before = pointers.current.get(event.pointerId);
    if (!before) {
      if (event.pointerType !== 'touch') props.onHover?.(place(event));
      return;
    }
    const [other] = [...pointers.current.entries()].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
    const now = { clientX: event.clientX, clientY: event.clientY };
    pointers.current.set(event.pointerId, now);
    if (other) {
      pinch(before, now, other);
      return;
    }
    const at = place(event);
    if (drag.current) drag.current.move(at, sideOf(event));
    else if (panFrom.current) {
      const [x, y] = panFrom.current; // the place under the pointer stays under it
      props.onView(kept(panned(view, x - at[0], y - at[1]), picture));
    }
  };
  const pinch = (before: Place, now: Place, other: Place): void => {
    const distance = (p: Place): number => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
    const between = (p: Place): Point =>
      place({ clientX: (p.clientX + other.clientX) / 2, clientY: (p.clientY + other.clientY) / 2 });
    const [was, centre] = [between(before), between(now)];
    const slid = panned(view, was[0] - centre[0], was[1] - centre[1]);
    props.onView(zoomed(slid, distance(now) / Math.max(1, distance(before)), was, picture));
  };
  const up = (event: PointerEvent): void => {
    pointers.current.delete(event.pointerId);
    const ended = drag.current;
    drag.current = null;
    panFrom.current = null;
    if (event.type === 'pointercancel') ended?.cancel?.();
    else ended?.end?.();
  };

  useEffect(() => {
    const element = svg.current;
    if (!element) return;
    const wheel = (event: WheelEvent): void => {
      event.preventDefault();
      props.onView(zoomed(view, Math.exp(-event.deltaY / 400), place(event), picture));
    };
    element.addEventListener('wheel', wheel, { passive: false });
    return () => element.removeEventListener('wheel', wheel);
  });
  useLayoutEffect(() => {
    const element = svg.current;
    if (!element || !props.onScale) return;
    const measure = (): void => props.onScale?.(element.getScreenCTM()?.a || 1);
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    measure();
    return () => observer.disconnect();
  }, [view.width, view.height]);

  return (
    <div
      class={`picture-editor ${props.class ?? ''}`}
      role="application"
      tabIndex={0}
      aria-label={props.label}
      aria-describedby={props.help}
      onKeyDown={props.onKey}
    >
      <svg
        ref={svg}
        viewBox={`${view.x} ${view.y} ${view.width} ${view.height}`}
        {...(props.reachable ? {} : { 'aria-hidden': 'true' as const })}
        onPointerDown={down}
        onPointerMove={move}
        onPointerUp={up}
        onPointerCancel={up}
        onPointerLeave={() => props.onHover?.(null)}
      >
        {props.children}
      </svg>
      {props.over}
    </div>
  );
}

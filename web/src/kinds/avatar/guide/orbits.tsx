/** Drawings of the ways that a camera goes around somebody. */

import type { ComponentChildren } from 'preact';

interface Props {
  /** What is drawn, in words. */
  label: string;
}

/** Half of a circle at a height, as it is seen a little from above: the half before or behind. */
const half = (height: number, before: boolean): string => `M14 ${height}A86 19 0 0 ${before ? 0 : 1} 186 ${height}`;

function Drawing({ label, children }: Props & { children: ComponentChildren }) {
  return (
    <svg class="orbits" viewBox="0 0 200 220" role="img" aria-label={label}>
      {children}
    </svg>
  );
}

/** The phone that goes, and which of the steps it is. */
function Phone({ x, y, step }: { x: number; y: number; step: number }) {
  return (
    <g>
      <rect class="phone" x={x - 6} y={y - 10} width="12" height="20" rx="2.5" />
      <circle class="step" cx={x} cy={y - 22} r="9" />
      <text x={x} y={y - 18.2}>
        {step}
      </text>
    </g>
  );
}

export function BodyOrbits({ label }: Props) {
  return (
    <Drawing label={label}>
      <path class="behind" d={half(82, false)} />
      <path class="behind" d={half(164, false)} />
      <path class="limbs" d="M86 60 62 112M114 60 138 112M92 112 84 200M108 112 116 200" />
      <path class="trunk" d="M88 62h24l-3 50H91z" />
      <circle class="skull" cx="100" cy="34" r="15" />
      <path class="way" d={half(82, true)} />
      <path class="way" d={half(164, true)} />
      <path class="way" d="m124 91 13 5-11 8M124 173l13 5-11 8" />
      <Phone x={40} y={95} step={2} />
      <Phone x={40} y={177} step={3} />
    </Drawing>
  );
}

export function HeadOrbits({ label }: Props) {
  return (
    <Drawing label={label}>
      <path class="behind" d={half(98, false)} />
      <path class="shoulders" d="M38 214c4-34 28-38 50-44v-24h24v24c22 6 46 10 50 44z" />
      <path class="skull" d="M64 96c0-36 14-54 36-54s36 18 36 54c0 34-18 58-36 58s-36-24-36-58z" />
      <path class="features" d="M80 96h10M110 96h10M100 100v16M90 130c6 4 14 4 20 0" />
      <path class="way" d={half(98, true)} />
      <path class="way" d="M180 72C164 12 60 2 30 52M30 52l0-13M30 52l12-4" />
      <path class="way" d="M172 128c-14 62-96 74-134 28M38 156l1 13M38 156l12 2" />
      <path class="way" d="m124 107 13 5-11 8" />
      <Phone x={40} y={112} step={1} />
      <Phone x={150} y={36} step={2} />
      <Phone x={136} y={192} step={3} />
    </Drawing>
  );
}

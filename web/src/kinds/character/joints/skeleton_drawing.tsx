/** A skeleton over its picture: limbs as lines, joints as dots that the keyboard can reach. */

import { type Joints, labelOf, limbs, sideOf } from './skeleton';

interface Props {
  joints: Joints;
  /** The names of the joints that have a dot. */
  shown: readonly string[];
  chosen?: string | null;
  /** Where it is missing, the dots are only seen. */
  onChoose?: ((name: string) => void) | undefined;
}

export function SkeletonDrawing({ joints, shown, chosen = null, onChoose }: Props) {
  const seen = new Set(shown);
  return (
    <>
      {limbs.map(({ from, to, side }) => {
        const [a, b] = [joints[from], joints[to]];
        if (!a || !b || !(seen.has(from) && seen.has(to))) return null;
        return <path key={from + to} class={`limb ${side ?? ''}`} d={`M${a[0]} ${a[1]}L${b[0]} ${b[1]}`} />;
      })}
      {shown.map((name) => {
        const place = joints[name];
        if (!place) return null;
        const kind = `joint ${sideOf(name) ?? ''} ${name === chosen ? 'chosen' : ''}`;
        const dot = `M${place[0]} ${place[1]}h0`;
        if (!onChoose) return <path key={name} class={kind} d={dot} />;
        return (
          <path
            key={name}
            class={kind}
            d={dot}
            role="button"
            tabIndex={0}
            aria-label={labelOf(name)}
            aria-pressed={name === chosen}
            onFocus={() => onChoose(name)}
          />
        );
      })}
    </>
  );
}

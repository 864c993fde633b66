/** A performance as a card: a picture that plays when it is pointed at, and a name. */

import { useState } from 'preact/hooks';
import type { Driver, Moment } from '../api';
import { momentName } from './drivers';
import { words } from './words';
import { plain } from '../language/strings';

/** What a card shows, and what a job names to be driven by it. */
interface Shown {
  value: string;
  label: string;
  title: string | undefined;
  url: string;
  poster: string | null;
}

/** A driver, then its moments. */
export const shownOf = (driver: Driver): Shown[] => [
  {
    value: driver.name,
    label: labelOf(driver),
    title: driver.title ?? undefined,
    url: driver.url,
    poster: driver.poster ?? null,
  },
  ...(driver.moments ?? []).map((moment) => ({
    value: momentName(driver.name, moment.name),
    label: momentLabel(moment),
    title: words.momentOf(plain(driver.name), moment.start.toFixed(1), moment.end.toFixed(1)),
    url: moment.url,
    poster: moment.poster,
  })),
];

interface CardProps extends Shown {
  checked: boolean;
  onChoose: () => void;
}

/** Shows a picture of the performance; plays it while it is pointed at or has the focus. */
export function Card({ value, label, title, url, poster, checked, onChoose }: CardProps) {
  const [lively, setLively] = useState(false);
  const begin = (): void => setLively(!matchMedia('(prefers-reduced-motion: reduce)').matches);
  const rest = (): void => setLively(false);
  return (
    <label
      class={checked ? 'card checked' : 'card'}
      title={title}
      onMouseEnter={begin}
      onMouseLeave={rest}
    >
      <input
        type="radio"
        name="performance"
        value={value}
        checked={checked}
        onChange={onChoose}
        onFocus={begin}
        onBlur={rest}
      />
      {poster && <img src={poster} alt="" loading="lazy" width="256" height="256" />}
      {(lively || !poster) && (
        <video
          key={String(lively)}
          src={url}
          muted
          loop
          playsInline
          autoPlay={lively}
          preload="metadata"
          aria-hidden="true"
          tabIndex={-1}
        />
      )}
      <span>{label}</span>
    </label>
  );
}

/** A built-in performance by its state, in the page's language; one's own by the name that it was kept under. */
export const labelOf = ({ name, state }: Driver): string => (state ? words.states[state] : plain(name));

/** A moment by its state, its number among those of the state, and how long it is. */
const momentLabel = ({ name, state, strength, seconds }: Moment): string => {
  const shown = words.states[state];
  const [, number = ''] = name.split('-');
  return words.moment(strength === 'strong' ? words.strong(shown) : shown, number, seconds.toFixed(1));
};

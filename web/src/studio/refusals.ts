/** Places of a studio that were given a file last that they cannot take: each by itself, until it is given something else. */

import { useDraft } from './draft';

export interface Refusals<Place extends string> {
  refused: Readonly<Partial<Record<Place, boolean>>>;
  refuse: (place: Place) => void;
  /** The place has been given something that it can take. */
  accept: (place: Place) => void;
}

/** Of the studio of a kind; held with its draft, so that nothing is chosen in a file's stead after a look at another page. */
export function useRefusals<Place extends string>(kind: string): Refusals<Place> {
  const [refused, change] = useDraft<Partial<Record<Place, boolean>>>(`${kind}, refused`, {});
  const mark = (place: Place, on: boolean): void => change({ [place]: on } as Partial<Record<Place, boolean>>);
  return { refused, refuse: (place) => mark(place, true), accept: (place) => mark(place, false) };
}

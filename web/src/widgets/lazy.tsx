/** A part of the page that is fetched when it is first needed, so that the page itself is there at once. */

import type { ComponentType } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import type { Load } from '../kind/kind';
import { strings } from '../language/strings';
import { ProblemAlert } from './problem_alert';

/** Parts that have arrived, by what fetched them. */
const arrived = new WeakMap<object, unknown>();

/** Fetch a part, so that it is there at once when it is shown. */
export async function preload<Props>(load: Load<Props>): Promise<ComponentType<Props>> {
  const loaded = (await load()).default;
  arrived.set(load, loaded);
  return loaded;
}

export function later<Props extends object>(load: Load<Props>) {
  return function Later(props: Props) {
    const [part, setPart] = useState(() => (arrived.get(load) as ComponentType<Props> | undefined) ?? null);
    const [failed, setFailed] = useState(false);
    const fetchPart = (): void => {
      setFailed(false);
      preload(load).then(
        (loaded) => setPart(() => loaded),
        () => setFailed(true),
      );
    };
    useEffect(() => {
      if (!part) fetchPart();
    }, []);
    if (failed) {
      return (
        <ProblemAlert code="unreachable" detail="">
          <button type="button" class="button" onClick={fetchPart}>
            {strings.retry}
          </button>
        </ProblemAlert>
      );
    }
    const Part = part;
    return Part ? <Part {...props} /> : <div class="later" aria-busy="true" />;
  };
}

const parts = new WeakMap<object, unknown>();

/** The part that this fetches: the same one for the same loader, however often it is asked for. */
export function part<Props extends object>(load: Load<Props>): ComponentType<Props> {
  const known = parts.get(load) as ComponentType<Props> | undefined;
  if (known) return known;
  const made = later(load);
  parts.set(load, made);
  return made;
}

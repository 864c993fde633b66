/** A part of the page that is fetched when it is first needed, so that the page itself is there at once. */

import type { ComponentType } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { strings } from '../strings';
import { Trouble } from './trouble';

export function later<Props extends object>(load: () => Promise<{ default: ComponentType<Props> }>) {
  let loaded: ComponentType<Props> | null = null;
  return function Later(props: Props) {
    const [part, setPart] = useState(() => loaded);
    const [failed, setFailed] = useState(false);
    const fetchPart = (): void => {
      setFailed(false);
      load().then(
        (module) => {
          loaded = module.default;
          setPart(() => loaded);
        },
        () => setFailed(true),
      );
    };
    useEffect(() => {
      if (!part) fetchPart();
    }, []);
    if (failed) {
      return (
        <Trouble code="unreachable" detail="">
          <button type="button" class="button" onClick={fetchPart}>
            {strings.retry}
          </button>
        </Trouble>
      );
    }
    const Part = part;
    return Part ? <Part {...props} /> : <div class="later" aria-busy="true" />;
  };
}

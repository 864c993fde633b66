/** Whether what is being sent is halted, for a button that halts it and takes it up again. */

import { useRef, useState } from 'preact/hooks';
import { Valve } from '../api/upload';

export function usePausing() {
  const [paused, setPaused] = useState(false);
  const valve = useRef(new Valve()).current;
  const pause = (on: boolean): void => {
    setPaused(on);
    valve.closed = on;
  };
  return { valve, paused, pause };
}

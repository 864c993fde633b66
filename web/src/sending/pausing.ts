/** Whether what is being sent is halted, for a button that halts it and takes it up again. */

import { useRef, useState } from 'preact/hooks';
import { PauseControl } from '../api/upload';

export function usePausing() {
  const [paused, setPaused] = useState(false);
  const pauseControl = useRef(new PauseControl()).current;
  const pause = (on: boolean): void => {
    setPaused(on);
    pauseControl.closed = on;
  };
  return { pauseControl, paused, pause };
}

/** A live portrait of a picture, from the camera's opening on. */

import type { RefObject } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { beginLive, type Live, type LiveEvent, type Obstacle, Problem, uploadPicture } from '../api';
import { asProblem } from '../api/loading';
import { feed } from './camera_feed';
import { type LiveLine, showLive } from './picture';

export interface LiveState {
  step: 'camera' | 'sending' | 'preparing' | 'searching' | 'calibrating' | 'live' | 'no_face' | 'ended';
  fraction: number;
  obstacle: Obstacle | null;
}

const step = (of: LiveState['step']): LiveState => ({ step: of, fraction: 0, obstacle: null });

export function useLive(
  portrait: File,
  stream: MediaStream | null,
  video: RefObject<HTMLVideoElement | null>,
  canvas: RefObject<HTMLCanvasElement | null>,
) {
  const [state, setState] = useState<LiveState>(step('camera'));
  const [problem, setProblem] = useState<Problem | null>(null);
  const [live, setLive] = useState<Live | null>(null);
  const [rate, setRate] = useState(0);
  const [turn, setTurn] = useState(0);
  const line = useRef<LiveLine | null>(null);

  useEffect(() => {
    if (!stream) return;
    let wanted = true;
    let stop = (): void => undefined;
    setProblem(null);
    setState(step('sending'));

    const fail = (error: unknown): void => {
      if (!wanted) return;
      stop();
      setProblem(asProblem(error));
      setState(step('ended'));
    };
    const take = (event: LiveEvent): void => {
      if (event.event === 'ended') fail(new Problem(0, event.code, event.detail));
      else if (event.event === 'calibrating') setState({ step: 'calibrating', fraction: event.fraction, obstacle: event.obstacle });
      else if (event.event === 'no_face') setState(({ step: was }) => step(was === 'live' || was === 'no_face' ? 'no_face' : 'searching'));
      else setState(step(event.event === 'ready' ? 'live' : event.event));
    };
    uploadPicture(portrait)
      .then(beginLive)
      .then((begun) => {
        if (!wanted || !video.current) return;
        setLive(begun);
        const opened = showLive(begun.stream, () => canvas.current, {
          onEvent: take,
          onLost: () => fail(new Problem(0, 'unreachable', '')),
        });
        line.current = opened;
        const stopFeeding = feed(video.current, opened);
        const counting = setInterval(() => setRate(opened.rate()), 500);
        stop = () => {
          clearInterval(counting);
          stopFeeding();
          opened.close();
        };
      })
      .catch(fail);
    return () => {
      wanted = false;
      stop();
    };
  }, [stream, turn]);

  return {
    state,
    problem,
    live,
    rate,
    again: () => setTurn((t) => t + 1),
    recalibrate: () => line.current?.send(JSON.stringify({ command: 'recalibrate' })),
  };
}

/** A reactive portrait, alive: it answers the pointer, and buttons lead it from state to state. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { words as performanceWords } from '../../performances/words';
import { words as portraitWords } from './words';
import { ProblemAlert } from '../../widgets/problem_alert';

const words = portraitWords.result;

/** What of the component the page uses; `web/reactive` makes it. */
interface ReactivePortrait extends HTMLElement {
  readonly states: readonly string[];
  readonly state: string;
  play(state: string): void;
}

const SCRIPT = '/reactive-portrait.js';

interface Props {
  profile: string;
  poster: string | undefined;
}

export function ReactivePlayer({ profile, poster }: Props) {
  const place = useRef<HTMLDivElement>(null);
  const portrait = useRef<ReactivePortrait | null>(null);
  const [states, setStates] = useState<string[]>([]);
  const [state, setState] = useState('');
  const [failed, setFailed] = useState(false);

  useEffect(() => {
    const element = document.createElement('reactive-portrait') as ReactivePortrait;
    element.setAttribute('src', profile);
    element.setAttribute('alt', words.livingAlt);
    if (poster) {
      element.setAttribute('poster', poster);
      const image = new Image(); // no bands beside or above a picture of another shape
      image.addEventListener('load', () => {
        element.style.aspectRatio = `${image.naturalWidth} / ${image.naturalHeight}`;
      });
      image.src = poster;
    }
    element.addEventListener('load', () => {
      setStates([...element.states]);
      setState(element.state);
    });
    element.addEventListener('statechange', () => setState(element.state));
    element.addEventListener('error', () => setFailed(true));
    place.current?.append(element);
    portrait.current = element;
    import(/* @vite-ignore */ SCRIPT).catch(() => setFailed(true));
    return () => element.remove();
  }, [profile]);

  return (
    <figure class="reactive-player">
      <div ref={place} />
      <figcaption>
        {failed ? <ProblemAlert code="profile_unplayable" detail={words.livingFailed} /> : <p>{words.living}</p>}
        <div class="actions">
          {states.map((one) => (
            <button
              key={one}
              type="button"
              class="toggle"
              aria-pressed={one === state}
              onClick={() => portrait.current?.play(one)}
            >
              {(performanceWords.states as Record<string, string>)[one] ?? one}
            </button>
          ))}
        </div>
      </figcaption>
    </figure>
  );
}

/** The character in the visitor's own room, by their device's AR; where there is none, at least from all sides. */

import '@google/model-viewer';
import type { ModelViewerElement } from '@google/model-viewer';
import { useEffect, useRef, useState } from 'preact/hooks';
import { getSkeleton } from '../artifacts/skeleton';
import { ProblemAlert } from '../../widgets/problem_alert';
import { Dialog } from '../../widgets/dialog';
import { useLoaded } from '../../api/loading';
import { strings } from '../../language/strings';
import { words } from '../words';
import { IN_PLACE, PICTURED } from '../scene/character';
import { peopleOf, type HasArtifacts } from '../artifacts/people';
import { PersonSelect } from '../person_select';

const said = { loading: words.loading, ready: words.spaceHint, flat: words.spaceNone, failed: '' };

interface Props {
  job: HasArtifacts;
  /** Reads the job once more, with links that have only now been signed. */
  renew: (signal: AbortSignal) => Promise<HasArtifacts>;
  /** Who is shown first, of those who were woken. */
  who: number;
  onClose: () => void;
}

export default function ArDialog({ job, renew, who: first, onClose }: Props) {
  // links are open for a while only, and what shows AR fetches the file by itself, late: give it fresh ones
  const fresh = useLoaded(renew, 'fresh links');
  const [who, setWho] = useState(first);
  const skeleton = useLoaded((signal) => getSkeleton(job, signal), 'skeleton').value;
  const people = peopleOf(fresh.value ?? job, skeleton);
  const place = useRef<HTMLDivElement>(null);
  const [state, setState] = useState<'loading' | 'ready' | 'flat' | 'failed'>('loading');
  const [viewer, setViewer] = useState<ModelViewerElement | null>(null);

  useEffect(() => {
    const { glb, usdz } = (fresh.value && peopleOf(fresh.value, null)[who]) ?? {};
    if (!glb || !place.current) return;
    setState('loading');
    const element = document.createElement('model-viewer') as ModelViewerElement;
    const attributes = {
      ar: '',
      'ar-modes': 'webxr scene-viewer quick-look',
      'camera-controls': '',
      'interaction-prompt': 'none',
      'touch-action': 'pan-y',
      'shadow-intensity': '1',
      // a clip that stands still, rather than the T-pose
      'animation-name': PICTURED,
      autoplay: '',
      alt: words.spaceAlt,
      ...(usdz && { 'ios-src': absolute(usdz.url) }),
      src: absolute(glb.url),
    };
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.addEventListener('load', () => {
      const motion = element.availableAnimations.find((name) => name.endsWith(IN_PLACE));
      if (motion && !matchMedia('(prefers-reduced-motion: reduce)').matches) element.animationName = motion;
      setState(element.canActivateAR ? 'ready' : 'flat');
    });
    element.addEventListener('error', () => setState('failed'));
    // its own button would be a second one, in no language of ours
    const slot = document.createElement('span');
    slot.slot = 'ar-button';
    element.append(slot);
    place.current.append(element);
    setViewer(element);
    return () => element.remove();
  }, [fresh.value, who]);

  return (
    <Dialog title={words.space} class="viewer-space" onClose={onClose}>
      {people.length > 1 && (
        <PersonSelect
          people={people}
          together={false}
          chosen={who}
          disabled={!fresh.value}
          onChoose={(one) => one !== 'all' && setWho(one)}
        />
      )}
      <div ref={place} class="viewer-room" aria-busy={state === 'loading'} />
      {state === 'failed' && <ProblemAlert code="character_unreadable" detail={words.failed} />}
      {fresh.problem && (
        <ProblemAlert code={fresh.problem.code} detail={fresh.problem.detail}>
          <button type="button" class="button" onClick={fresh.reload}>
            {strings.retry}
          </button>
        </ProblemAlert>
      )}
      <p role="status">{said[state]}</p>
      {state === 'ready' && (
        <footer class="actions">
          <button type="button" class="button primary" onClick={() => void viewer?.activateAR()}>
            {words.spaceOpen}
          </button>
        </footer>
      )}
    </Dialog>
  );
}

/** Apps outside the browser know no address that this page is at. */
const absolute = (url: string): string => new URL(url, location.href).href;

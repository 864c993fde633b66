/** The start page: choose a portrait and a performance, set it going, find what was made before. */

import { useEffect, useState } from 'preact/hooks';
import { listDrivers } from '../api';
import { Capture } from '../components/capture';
import { FoldedChoices, optionsOf } from '../components/choices';
import { useDropsAnywhere } from '../components/drops';
import { Demo } from '../components/demo';
import { Dropzone } from '../components/dropzone';
import { Launch } from '../components/launch';
import { Making } from '../components/making';
import { type Performance, Performances } from '../components/performances';
import { Recent } from '../components/recent';
import { Samples } from '../components/samples';
import { Trouble } from '../components/trouble';
import type { Draft, PortraitDraft } from '../drafts';
import { useLoaded } from '../loading';
import { isPicture, isVideo, pictureTypes } from '../media';
import { namesOf, portraitOrder } from '../order';
import { portraitSamples } from '../samples';
import { useSending } from '../sending';
import { strings } from '../strings';

const words = strings.studio;

/** How often drivers that are being searched for moments are looked at. */
const LOOK_MS = 2000;

/** What is acted out where nothing else is chosen: the mood of the clip above. */
const USUAL = 'happy';

export function StudioPage({ draft }: { draft: Draft<PortraitDraft> }) {
  const [{ portrait, performance: chosen, choices }, change] = draft;
  const [refused, setRefused] = useState<'portrait' | 'video' | null>(null);
  const setPortrait = (portrait: File): void => {
    setRefused((part) => (part === 'portrait' ? null : part));
    change({ portrait });
  };
  const setPerformance = (performance: Performance): void => {
    setRefused((part) => (part === 'video' ? null : part));
    change({ performance });
  };
  const refusePortrait = (): void => {
    setRefused('portrait');
    change({ portrait: null });
  };
  const refuseVideo = (): void => {
    setRefused('video');
    change({ performance: null });
  };
  const [keeping, setKeeping] = useState(false);
  const drivers = useLoaded(listDrivers, 'drivers');
  const usual = drivers.value?.find(({ name }) => name === USUAL);
  const performance: Performance | null = refused === 'video' ? null : chosen ?? (usual ? { by: 'name', name: usual.name } : null);
  const searching = drivers.value?.some((driver) => driver.moments_status === 'pending') ?? false;
  useEffect(() => {
    if (!searching) return;
    const timer = setInterval(drivers.reload, LOOK_MS);
    return () => clearInterval(timer);
  }, [searching]);
  const sending = useSending();
  useDropsAnywhere(async (file) => {
    if (await isPicture(file)) setPortrait(file);
    else if (await isVideo(file)) setPerformance({ by: 'file', file });
    else return false;
    return true;
  }, refusePortrait);
  useEffect(() => {
    document.title = strings.name;
  }, []);

  const hasSound = performance?.by === 'file';
  const wrong = refused && (refused === 'video' ? words.wrongVideo : words.wrongPicture);
  const needed = wrong ?? (!portrait ? words.needPortrait : !performance ? words.needPerformance : '');
  const missing = keeping ? words.keepingFirst : needed;
  const order =
    portrait && performance ? () => portraitOrder(portrait, performance, optionsOf(choices, hasSound)) : null;
  const start = (event: Event): void => {
    event.preventDefault();
    if (order && !keeping) sending.begin(order());
  };

  return (
    <>
      <form class="studio" onSubmit={start}>
        <header>
          <div>
            <Making kind="portrait" />
            <h1>{words.title}</h1>
            <p>{words.lead}</p>
          </div>
          <Demo
            still="/samples/grace-hopper-still.jpg"
            moving="/samples/grace-hopper-happy.mp4"
            alt={strings.demo.portrait}
            width={400}
            height={480}
          />
        </header>
        <div class="beside">
          <section class="panel" aria-labelledby="portrait-title">
            <h2 id="portrait-title">{words.portrait}</h2>
            <p class="hint">{words.portraitHint}</p>
            <Samples names={portraitSamples} chosen={portrait} onChoose={setPortrait} />
            <Dropzone
              media="image"
              file={portrait}
              accept={pictureTypes}
              accepts={isPicture}
              words={{
                drop: words.portraitDrop,
                browse: words.portraitBrowse,
                chosen: words.portraitChosen,
                wrong: words.wrongPicture,
              }}
              onFile={setPortrait}
              refused={refused === 'portrait'}
              onRefused={refusePortrait}
            />
            <Capture media="image" onFile={setPortrait} />
          </section>
        </div>
        <section class="panel" aria-labelledby="performance-title">
          <h2 id="performance-title">{words.performance}</h2>
          <p class="hint">{words.performanceHint}</p>
          {drivers.problem && (
            <Trouble code={drivers.problem.code} detail={drivers.problem.detail}>
              <button type="button" class="button" onClick={drivers.reload}>
                {strings.retry}
              </button>
            </Trouble>
          )}
          <Performances
            drivers={drivers.value ?? []}
            chosen={performance}
            onChoose={setPerformance}
            refused={refused === 'video'}
            onRefused={refuseVideo}
            sending={sending.step !== null}
            onKeeping={setKeeping}
            onKept={drivers.reload}
          />
          <FoldedChoices value={choices} mayHaveSound={hasSound} onChange={(choices) => change({ choices })} />
        </section>
        <Launch sending={sending} missing={missing} chosen={order && namesOf(order())} label={words.start} />
      </form>
      <Recent />
    </>
  );
}

/** The start page: choose a portrait and a performance, set it going, find what was made before. */

import { useEffect, useState } from 'preact/hooks';
import { listDrivers } from '../api';
import { Capture } from '../components/capture';
import { FoldedChoices, optionsOf, usual } from '../components/choices';
import { useDropsAnywhere } from '../components/drops';
import { Dropzone } from '../components/dropzone';
import { Launch } from '../components/launch';
import { Making } from '../components/making';
import { type Performance, Performances } from '../components/performances';
import { Recent } from '../components/recent';
import { Trouble } from '../components/trouble';
import { useLoaded } from '../loading';
import { isPicture, isVideo, pictureTypes } from '../media';
import { portraitOrder } from '../order';
import { useSending } from '../sending';
import { strings } from '../strings';

const words = strings.studio;

/** How often drivers that are being searched for moments are looked at. */
const LOOK_MS = 2000;

export function StudioPage() {
  const [portrait, setPortrait] = useState<File | null>(null);
  const [performance, setPerformance] = useState<Performance | null>(null);
  const [choices, setChoices] = useState(usual);
  const [keeping, setKeeping] = useState(false);
  const drivers = useLoaded(listDrivers, 'drivers');
  const searching = drivers.value?.some((driver) => driver.moments_status === 'pending') ?? false;
  useEffect(() => {
    if (!searching) return;
    const timer = setInterval(drivers.reload, LOOK_MS);
    return () => clearInterval(timer);
  }, [searching]);
  const sending = useSending();
  useDropsAnywhere((file) => {
    if (isPicture(file)) setPortrait(file);
    else if (isVideo(file)) setPerformance({ by: 'file', file });
  });
  useEffect(() => {
    document.title = strings.name;
  }, []);

  const hasSound = performance?.by === 'file';
  const needed = !portrait ? words.needPortrait : !performance ? words.needPerformance : '';
  const missing = keeping ? words.keepingFirst : needed;
  const start = (event: Event): void => {
    event.preventDefault();
    if (portrait && performance && !keeping) sending.begin(portraitOrder(portrait, performance, optionsOf(choices, hasSound)));
  };

  return (
    <>
      <form class="studio" onSubmit={start}>
        <header>
          <Making kind="portrait" />
          <h1>{words.title}</h1>
          <p>{words.lead}</p>
        </header>
        <div class="beside">
          <section class="panel" aria-labelledby="portrait-title">
            <h2 id="portrait-title">{words.portrait}</h2>
            <p class="hint">{words.portraitHint}</p>
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
            sending={sending.step !== null}
            onKeeping={setKeeping}
            onKept={drivers.reload}
          />
          <FoldedChoices value={choices} mayHaveSound={hasSound} onChange={setChoices} />
        </section>
        <Launch sending={sending} missing={missing} label={words.start} />
      </form>
      <Recent />
    </>
  );
}

/** The start page: choose a portrait and a performance, set it going, find what was made before. */

import { useEffect, useState } from 'preact/hooks';
import { listDrivers } from '../../api';
import { Capture } from '../../studio/capture';
import { type Choices, FoldedChoices, optionsOf, usual as defaults } from './choices';
import { useDropsAnywhere } from '../../studio/drops';
import { Demo } from '../../studio/demo';
import { Dropzone } from '../../widgets/dropzone';
import { Launch } from '../../studio/launch';
import { KindLinks } from '../../studio/kind_links';
import { Performances } from './performances';
import { Recent } from '../../works/recent';
import { Samples } from '../../studio/samples';
import { Trouble } from '../../widgets/trouble';
import { useDraft } from '../../studio/draft';
import { useRefusals } from '../../studio/refusals';
import { useLoaded } from '../../loading';
import { isPicture, isVideo, pictureTypes } from '../../media';
import type { StudioProps } from '../../kind';
import { namesOf, type Performance, portraitOrder } from './order';
import { words as portraitWords } from './words';
import { portraitSamples } from '../../studio/sample_pictures';
import { useSending } from '../../sending';
import { strings } from '../../strings';

const words = strings.studio;

/** How often drivers that are being searched for moments are looked at. */
const SEARCH_POLL_MS = 2000;

/** What is acted out where nothing else is chosen: the mood of the clip above. */
const DEFAULT_PERFORMANCE = 'happy';

interface Draft {
  portrait: File | null;
  /** Null: nobody has chosen yet. */
  performance: Performance | null;
  choices: Choices;
}

const EMPTY_DRAFT: Draft = { portrait: null, performance: null, choices: defaults };

export default function PortraitStudio({ kind }: StudioProps) {
  const [{ portrait, performance: chosen, choices }, change] = useDraft(kind.name, EMPTY_DRAFT);
  const { refused, refuse, accept } = useRefusals<'portrait' | 'video'>(kind.name);
  const setPortrait = (portrait: File): void => {
    accept('portrait');
    change({ portrait });
  };
  const setPerformance = (performance: Performance): void => {
    accept('video');
    change({ performance });
  };
  const refusePortrait = (): void => {
    refuse('portrait');
    change({ portrait: null });
  };
  const refuseVideo = (): void => {
    refuse('video');
    change({ performance: null });
  };
  const [keeping, setKeeping] = useState(false);
  const drivers = useLoaded(listDrivers, 'drivers');
  const usual = drivers.value?.find(({ name }) => name === DEFAULT_PERFORMANCE);
  const performance: Performance | null = refused.video ? null : chosen ?? (usual ? { by: 'name', name: usual.name } : null);
  const searching = drivers.value?.some((driver) => driver.moments_status === 'pending') ?? false;
  useEffect(() => {
    if (!searching) return;
    const timer = setInterval(drivers.reload, SEARCH_POLL_MS);
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
  const wrong = refused.portrait ? words.wrongPicture : refused.video ? words.wrongVideo : null;
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
            <KindLinks current={kind.name} />
            <h1>{words.title}</h1>
            <p>{words.lead}</p>
          </div>
          <Demo
            still="/samples/grace-hopper-still.jpg"
            moving="/samples/grace-hopper-happy.mp4"
            alt={portraitWords.demo}
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
              refused={refused.portrait === true}
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
            refused={refused.video === true}
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

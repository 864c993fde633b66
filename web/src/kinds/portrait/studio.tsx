/** The start page: choose a portrait and a performance, set it going, find what was made before. */

import { useState } from 'preact/hooks';
import { type Choices, FoldedChoices, optionsOf, defaults } from './choices';
import { useDropsAnywhere } from '../../studio/given_files/drops';
import { Demo } from '../../studio/samples/demo';
import { AUTO } from '../../performances/drivers';
import { PerformancePanel } from '../../performances/performance_panel';
import { useDrivers } from '../../performances/use_drivers';
import { words as performanceWords } from '../../performances/words';
import { SpecialCards } from './special_cards';
import { DriveLive } from '../../live/button';
import { StudioForm, useStudioTitle } from '../../studio/form';
import { PicturePanel } from '../../studio/given_files/picture_panel';
import { RecentWorks } from '../../works/recent_works';
import { useDraft } from '../../studio/draft';
import { useRefusals } from '../../studio/refusals';
import { isPicture, isVideo } from '../../studio/given_files/media_types';
import type { StudioProps } from '../../kind/kind';
import { type Performance, portraitOrder } from './order';
import { words as portraitWords } from './words';
import { samples } from './samples';
import { useSending } from '../../sending/use_sending';
import { strings } from '../../language/strings';

const words = portraitWords.studio;

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
  const drivers = useDrivers();
  const usual = drivers.value?.find(({ name }) => name === DEFAULT_PERFORMANCE);
  const performance: Performance | null = refused.video ? null : chosen ?? (usual ? { by: 'name', name: usual.name } : null);
  const sending = useSending();
  useStudioTitle(kind);
  useDropsAnywhere(async (file) => {
    if (await isPicture(file)) setPortrait(file);
    else if (await isVideo(file)) setPerformance({ by: 'file', file });
    else return false;
    return true;
  }, refusePortrait);

  const keepTake = (portrait: File, take: File): void => {
    setPerformance({ by: 'file', file: take });
    sending.begin(portraitOrder(portrait, { by: 'file', file: take }, optionsOf(choices, true)));
  };

  const hasSound = performance?.by === 'file';
  const wrong = refused.portrait ? strings.studio.wrongPicture : refused.video ? performanceWords.ownVideo.wrong : null;
  const needed = wrong ?? (!portrait ? words.needPortrait : !performance ? words.needPerformance : '');
  const missing = keeping ? words.keepingFirst : needed;
  const order =
    portrait && performance ? () => portraitOrder(portrait, performance, optionsOf(choices, hasSound)) : null;

  return (
    <>
      <StudioForm
        kind={kind}
        title={words.title}
        lead={words.lead}
        demo={
          <Demo
            still="/samples/grace-hopper-still.jpg"
            moving="/samples/grace-hopper-happy.mp4"
            alt={portraitWords.demo}
            width={400}
            height={480}
          />
        }
        sending={sending}
        missing={missing}
        order={order}
        label={words.start}
      >
        <PicturePanel
          title={words.portrait}
          hint={words.portraitHint}
          samples={samples}
          of="face"
          file={portrait}
          chosenLabel={words.portraitChosen}
          refused={refused.portrait === true}
          onFile={setPortrait}
          onRefused={refusePortrait}
        />
        <PerformancePanel
          title={words.performance}
          hint={words.performanceHint}
          drivers={drivers}
          chosen={performance?.by === 'reactive' ? null : performance}
          onChoose={setPerformance}
          refused={refused.video === true}
          onRefused={refuseVideo}
          sending={sending.step !== null}
          onKeeping={setKeeping}
          onGone={() => setPerformance({ by: 'name', name: AUTO })}
          options={
            <>
              <div class="actions">
                <DriveLive portrait={refused.portrait ? null : portrait} onTake={keepTake} />
              </div>
              <FoldedChoices value={choices} mayHaveSound={hasSound} onChange={(choices) => change({ choices })} />
            </>
          }
        >
          <SpecialCards chosen={performance} onChoose={setPerformance} />
        </PerformancePanel>
      </StudioForm>
      <RecentWorks />
    </>
  );
}

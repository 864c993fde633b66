/** The start page of personas: photos or an earlier persona, who agreed, what it is to play, and off it goes. */

import { useState } from 'preact/hooks';
import type { StudioProps } from '../../kind/kind';
import { strings } from '../../language/strings';
import { PerformancePanel } from '../../performances/performance_panel';
import { isStill, type Performance } from '../../performances/performance';
import { useDrivers } from '../../performances/use_drivers';
import { words as performanceWords } from '../../performances/words';
import { useSending } from '../../sending/use_sending';
import { collectedFrom, joined } from '../../studio/given_files/collection';
import { Consent } from '../../studio/consent';
import { useDataAnywhere } from '../../studio/given_files/drops';
import { StudioForm, useStudioTitle } from '../../studio/form';
import { isVideo } from '../../studio/given_files/media_types';
import { useRefusals } from '../../studio/refusals';
import { SymbolCard } from '../../studio/symbol_card';
import { RecentWorks } from '../../works/recent_works';
import { Advice } from './collection/advice';
import { EarlierPersonas } from './collection/earlier_personas';
import { PerformerPhotos } from './collection/performer_photos';
import { PhotosPanel } from './collection/photos_panel';
import { useGiving } from './collection/use_giving';
import { actsByPhoto, CompositeField, isPuppet, USUAL_COMPOSITE, useComposites } from './composite_field';
import { type Draft, usePersonaDraft } from './draft';
import { PersonaOptionFields } from './option_fields';
import { personaOrder, type Source } from './order';
import type { Options } from '../generic/fields';
import { Toggles } from '../../widgets/toggles';
import { MIN_PHOTOS, MAX_FILES } from './types';
import { words as personaWords } from './words';
import './styles/studio.css';

const words = personaWords.studio;
const DEFAULT_PERFORMANCE = 'happy';
/** A path in a square of 48: a face without an expression. */
const FACE = 'M24 8a16 16 0 1 1 0 32 16 16 0 0 1 0-32M18 20v2m12-2v2M18 31h12';

export default function PersonaStudio({ kind }: StudioProps) {
  const [draft, change] = usePersonaDraft();
  const { refused, refuse, accept } = useRefusals<'photos' | 'performer' | 'video'>(kind.name);
  const [keeping, setKeeping] = useState(false);
  const drivers = useDrivers();
  const sending = useSending();
  useStudioTitle(kind);

  const giving = useGiving(
    ({ photos, others }) => {
      accept('photos');
      // others may show somebody else: that has to be said anew
      change((before) => ({ from: 'photos', photos: joined(before.photos, photos), others, agreed: false }));
    },
    () => refuse('photos'),
  );
  const play = (performance: Performance | null): void => {
    accept('video');
    change({ performance });
  };
  useDataAnywhere(async (data) => {
    const given = await collectedFrom(data);
    const [first] = given;
    if (given.length === 1 && (await isVideo(first!.file))) play({ by: 'file', file: first!.file });
    else giving.give(Promise.resolve(given));
  });

  const usual = drivers.value?.find(({ name }) => name === DEFAULT_PERFORMANCE);
  const performance = refused.video ? null : draft.performance === undefined ? (usual ? { by: 'name' as const, name: usual.name } : null) : draft.performance;
  const source = sourceOf(draft);
  const composites = useComposites();
  const still = performance?.by === 'file' && isStill(performance.file);
  const composite = compositeOf(draft, composites);
  const options = optionsOf(draft, performance, composite);
  return (
    <>
      <StudioForm
        kind={kind}
        title={words.title}
        lead={words.lead}
        sending={sending}
        missing={keeping ? words.keepingFirst : missingIn(draft, refused)}
        order={source && (() => personaOrder({ source, performance, performer: draft.performer, backdrop: isPuppet(composite) ? draft.backdrop : null, options }))}
        label={draft.from === 'photos' ? words.start : words.startAgain}
      >
        <section class="panel wide" aria-labelledby="source-title">
          <h2 id="source-title">{draft.from === 'photos' ? words.photos : words.earlier}</h2>
          <Toggles
            label={words.sources}
            choices={['photos', 'persona'] as const}
            name={(one) => words.sourceNames[one]}
            chosen={draft.from}
            onChoose={(from) => change({ from })}
          />
          {draft.from === 'photos' ? (
            <PhotosPanel
              words={words.collection}
              least={MIN_PHOTOS}
              photos={draft.photos}
              others={draft.others}
              refused={refused.photos === true}
              giving={giving}
              onRemoved={(photo) => change(({ photos }) => ({ photos: photos.filter((one) => one !== photo) }))}
              onCleared={() => change({ photos: [], others: 0, agreed: false })}
            />
          ) : (
            <EarlierPersonas chosen={draft.persona?.id ?? null} onChoose={(persona) => change({ persona })} />
          )}
        </section>
        {draft.from === 'photos' && <Advice />}
        {needsConsent(draft) && (
          <section class={draft.from === 'photos' ? 'panel' : 'panel wide'} aria-label={words.consentTitle}>
            <Consent words={words} given={draft.agreed} onChange={(agreed) => change({ agreed })} />
          </section>
        )}
        <PerformancePanel
          wide
          title={words.performance}
          hint={words.performanceHint}
          drivers={drivers}
          chosen={performance}
          onChoose={play}
          refused={refused.video === true}
          onRefused={() => {
            refuse('video');
            change({ performance: null });
          }}
          sending={sending.step !== null}
          onKeeping={setKeeping}
          onGone={() => play(null)}
          pictures
          options={
            performance && (
              <>
                <CompositeField
                  value={composite}
                  onChange={(composite) => change(({ options }) => ({ options: { ...options, composite } }))}
                />
                {(still || !actsByPhoto(composite)) && (
                  <PerformerPhotos
                    photos={draft.performer}
                    refused={refused.performer === true}
                    onAdded={(photos) => {
                      accept('performer');
                      change(({ performer }) => ({ performer: joined(performer, photos), agreed: false }));
                    }}
                    onRefused={() => refuse('performer')}
                    onRemoved={(photo) => change(({ performer }) => ({ performer: performer.filter((one) => one !== photo) }))}
                    onCleared={() => change({ performer: [] })}
                  />
                )}
                <details class="choices">
                  <summary>{strings.studio.options}</summary>
                  <PersonaOptionFields
                    value={{ ...draft.options, composite }}
                    mayHaveSound={performance.by === 'file' && !still}
                    backdrop={draft.backdrop}
                    onBackdrop={(backdrop) => change({ backdrop })}
                    onChange={(options) => change({ options })}
                  />
                </details>
              </>
            )
          }
        >
          {draft.from === 'photos' && (
            <SymbolCard
              value="none"
              symbol={FACE}
              label={words.none}
              hint={words.noneHint}
              checked={performance === null && !refused.video && drivers.value !== null}
              onChoose={() => play(null)}
            />
          )}
        </PerformancePanel>
      </StudioForm>
      <RecentWorks />
    </>
  );
}

function sourceOf({ from, photos, persona }: Draft): Source | null {
  if (from === 'photos') return photos.length ? { by: 'photos', photos } : null;
  return persona && { by: 'persona', ...persona };
}

const needsConsent = ({ from, performer }: Draft): boolean => from === 'photos' || performer.length > 0;

/** As it was chosen, where the service has that. */
function compositeOf({ options }: Draft, offered: readonly string[]): string {
  const wanted = String(options.composite ?? USUAL_COMPOSITE);
  return offered.includes(wanted) ? wanted : USUAL_COMPOSITE;
}

/** What is to be sent: nothing that holds anyway, and nothing that has no meaning here. */
function optionsOf({ options }: Draft, performance: Performance | null, composite: string): Options {
  const { sound, composite: _wanted, ...others } = options;
  const mayHaveSound = performance?.by === 'file' && !isStill(performance.file);
  return { ...others, ...(sound === true && mayHaveSound && { sound }), ...(performance && composite !== USUAL_COMPOSITE && { composite }) };
}

/** What stands in the way of an order; empty where nothing does. */
function missingIn(draft: Draft, refused: { photos?: boolean; performer?: boolean; video?: boolean }): string {
  if (refused.video) return performanceWords.ownEither.wrong;
  if (refused.performer) return words.wrongPerformer;
  if (draft.from === 'persona') {
    if (!draft.persona) return words.needPersona;
    if (draft.performance === null) return words.needPerformance;
  } else {
    if (refused.photos) return words.wrongPhotos;
    if (!draft.photos.length) return words.needPhotos;
    if (draft.photos.length > MAX_FILES) return words.tooMany(MAX_FILES);
  }
  return draft.agreed || !needsConsent(draft) ? '' : words.needConsent;
}

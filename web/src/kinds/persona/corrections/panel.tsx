/** Everything about a persona that can be put right by hand, and the order to make it again. */

import { useMemo, useRef, useState } from 'preact/hooks';
import { randomKey } from '../../../api/idempotency';
import type { CorrectionsProps } from '../../../kind/kind';
import { useKind } from '../../../kind/kinds';
import { strings } from '../../../language/strings';
import { mayRepeat } from '../../../result/next_step';
import { useRevision } from '../../../sending/use_revision';
import { SendingBar } from '../../../studio/sending_bar';
import { SubmitRow } from '../../../studio/submit_row';
import { isFileId } from '../../../works/inputs';
import { useFaces } from '../faces/use_faces';
import { PersonaOptionFields } from '../option_fields';
import { examplesIn, MIN_PHOTOS } from '../types';
import { words as personaWords } from '../words';
import { actsByPhoto, CompositeField, USUAL_COMPOSITE } from '../composite_field';
import { isStill } from '../../../performances/performance';
import { ActingPhotoField } from './acting_photo_field';
import { AverageLightField } from './average_light_field';
import { draftOf, isChanged, isUsed, type RevisionDraft, revisionOf } from './changes';
import { FacesField, usedCount } from './faces_field';
import { PerformanceField } from './performance_field';
import { PersonField } from './person_field';
import '../../../styles/corrections.css';
import '../styles/corrections.css';

const words = personaWords.correct;
/** What more photos help against. */
const OF_PHOTOS = ['too_few_photos', 'no_photos', 'no_common_person'];

export default function PersonaPanel({ job, onProblem }: CorrectionsProps) {
  const before = useMemo(() => draftOf(job), [job.id]);
  const [draft, setDraft] = useState(before);
  const key = useRef(randomKey());
  const faces = useFaces(job);
  const kind = useKind(job.kind);
  const sending = useRevision(job, key, onProblem);
  const wish = (part: Partial<RevisionDraft>): void => {
    key.current = randomKey(); // another wish is another order
    setDraft((known) => ({ ...known, ...part }));
  };
  const setOption = (name: string, wanted: unknown): void => {
    const { [name]: _before, ...others } = draft.options;
    wish({ options: wanted === undefined ? others : { ...others, [name]: wanted } });
  };
  const again = isChanged(before, draft) || mayRepeat(job);
  const examples = examplesIn(job);
  // whose faces there are is not known as long as it is not known who is meant
  const sorted = faces !== null && examples.length === 0 && draft.example === before.example;
  const tooFew = sorted && usedCount(faces, before, draft) < MIN_PHOTOS;
  const playsStill = draft.performance !== 'held' && draft.performance.by === 'file' && isStill(draft.performance.file);
  const playsFile = draft.performance === 'held' ? isFileId(job.inputs.driver) : draft.performance.by === 'file';
  return (
    <form
      class="corrections persona"
      onSubmit={(event) => {
        event.preventDefault();
        if (again && !tooFew) sending.send(revisionOf(job, before, draft));
      }}
    >
      {OF_PHOTOS.includes(job.error?.code ?? '') && (
        <section class="panel whole">
          <p>{words.addPhotosHint}</p>
          <div class="actions">
            <a class="button primary" href={kind.link}>
              {words.addPhotos}
            </a>
          </div>
        </section>
      )}
      {sorted && <FacesField faces={faces} before={before} value={draft} onChange={wish} />}
      {faces && <PersonField faces={faces} examples={examples} value={draft.example} onChange={(example) => wish({ example })} />}
      <section class="panel whole" aria-label={words.performance}>
        <details class="choices">
          <summary>{words.performance}</summary>
          <PerformanceField
            job={job}
            value={draft.performance}
            sending={sending.step !== null}
            onChange={(performance) => wish({ performance })}
          />
        </details>
        <details class="choices">
          <summary>{words.options}</summary>
          <CompositeField
            value={String(draft.options.composite ?? USUAL_COMPOSITE)}
            onChange={(one) => setOption('composite', one === USUAL_COMPOSITE ? undefined : one)}
          />
          {sorted && actsByPhoto(String(draft.options.composite ?? USUAL_COMPOSITE)) && (
            <ActingPhotoField
              faces={faces}
              isUsed={(number) => isUsed(number, faces.sheet.faces[number]!, before, draft)}
              value={(draft.options.photo as number | null | undefined) ?? null}
              onChange={(photo) => setOption('photo', photo ?? undefined)}
            />
          )}
          {sorted && (
            <AverageLightField
              faces={faces}
              isUsed={(number) => isUsed(number, faces.sheet.faces[number]!, before, draft)}
              value={(draft.options.average_light as readonly number[] | undefined) ?? []}
              onChange={(photos) => setOption('average_light', photos.length ? photos : undefined)}
            />
          )}
          <PersonaOptionFields value={draft.options} mayHaveSound={playsFile && !playsStill} onChange={(options) => wish({ options })} />
        </details>
      </section>
      <div class="launch">
        {sending.step ? (
          <SendingBar files={personaWords.files} step={sending.step} paused={sending.paused} onPause={sending.pause} onStop={sending.stop} />
        ) : (
          <SubmitRow
            hint={tooFew ? words.tooFew(MIN_PHOTOS) : again ? '' : strings.redo.unchanged}
            disabled={sending.busy || !again || tooFew}
            label={strings.redo.send}
          />
        )}
      </div>
    </form>
  );
}

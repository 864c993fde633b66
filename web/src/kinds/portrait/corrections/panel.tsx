/** Everything about a portrait that can be put right by hand, and the order to make it again. */

import { useMemo, useRef, useState } from 'preact/hooks';
import { reviseJob } from '../../../api';
import { foundFaces, type PortraitReport, getLandmarks, portraitOptions, type PortraitChanges } from '../types';
import { Checkbox } from '../../../widgets/checkbox';
import type { CorrectionsProps } from '../../../kind/kind';
import { ChoiceFields } from '../choices';
import { later } from '../../../widgets/lazy';
import { SelectField } from '../../../widgets/select';
import { SubmitRow } from '../../../studio/submit_row';
import { FormatField, RateField, SizeField } from '../../../studio/video_fields';
import { randomKey } from '../../../api/idempotency';
import type { Points } from '../landmarks/scheme';
import { faceInBox } from '../landmarks/template';
import { asProblem, useLoaded } from '../../../api/loading';
import { LoadingProblem } from '../../../widgets/problem_alert';
import { isFileId } from '../../../works/inputs';
import { mayRepeat } from '../../../result/next_step';
import { AUTO, performanceUrl } from '../../../performances/drivers';
import { jobLink } from '../../../route';
import { words as portraitWords } from '../words';
import { strings } from '../../../language/strings';
import { revisionOptions, sameFrames, type RevisionDraft, draftOf } from './changes';
import { NeutralFrame } from './neutral';
import { DriverFaceField, TrimField } from './performance';
import { usePicture } from '../../../result/use_picture';
import { FaceChoice } from './picture';
import '../../../styles/corrections.css';

const LandmarkEditor = later(() => import('../landmarks/landmark_editor'));
const words = portraitWords.corrections;
const crops = ['none', 'bust', 'face'] as const;

export default function CorrectionPanel({ job, report: told, onProblem }: CorrectionsProps) {
  const report = told as PortraitReport | null;
  const made = portraitOptions(job);
  const asMade = useMemo(() => draftOf(made), [job.id]);
  const [draft, setWishes] = useState<RevisionDraft>(asMade);
  const [editing, setEditing] = useState(false);
  const [sending, setSending] = useState(false);
  const key = useRef(randomKey());
  const read = useLoaded((signal) => getLandmarks(job, signal), job.id);
  const found = read.value;
  const picture = usePicture(job, found?.size ?? null, (made.crop ?? 'none') !== 'none');
  const faces = report?.inputs.faces ?? foundFaces(job);
  const mayPlace = job.error?.correctable?.includes('landmarks') ?? false;

  /** Where the editor begins: with what was placed, with what was found for this face, or in this face's box. */
  const before = useMemo<Points | null>(() => {
    if (draft.landmarks) return draft.landmarks;
    if (draft.face === (made.face_index ?? 0)) return found?.landmarks ?? null;
    const box = faces[draft.face];
    return box ? faceInBox(box) : null;
  }, [draft.landmarks, draft.face, found, report]);

  const again = mayRepeat(job) || JSON.stringify(revisionOptions(draft)) !== JSON.stringify(revisionOptions(asMade));

  const wish = (part: Partial<RevisionDraft>): void => {
    key.current = randomKey(); // another wish is another order
    setWishes((known) => {
      const next = { ...known, ...part };
      if (sameFrames(known, next)) return next;
      return { ...next, neutral: sameFrames(asMade, next) ? asMade.neutral : null }; // its number would be another frame's
    });
  };
  const send = async (options: PortraitChanges): Promise<void> => {
    setSending(true);
    onProblem(null);
    try {
      const revised = await reviseJob(job.id, { options }, key.current);
      location.hash = jobLink(revised.id);
    } catch (error) {
      onProblem(asProblem(error));
      setSending(false);
    }
  };
  const place = (landmarks: Points): void => {
    setEditing(false);
    wish({ landmarks: landmarks.map(([x, y]) => [rounded(x), rounded(y)]) });
  };

  const hint = (): string => {
    if (draft.landmarks) return words.landmarksPlaced;
    if (faces.length > 1) return words.faces(faces.length);
    return mayPlace ? words.placeHint : words.landmarksHint;
  };

  return (
    <form
      class="corrections"
      onSubmit={(event) => {
        event.preventDefault();
        void send(revisionOptions(draft));
      }}
    >
      <section class="panel" aria-label={words.picture}>
        <h3>{words.picture}</h3>
        <LoadingProblem of={read} />
        {picture && (
          <FaceChoice
            picture={picture}
            faces={draft.landmarks ? [] : faces}
            chosen={draft.face}
            landmarks={draft.landmarks ?? (draft.face === (made.face_index ?? 0) ? (found?.landmarks ?? null) : null)}
            onChoose={(face) => wish({ face, landmarks: null })}
          />
        )}
        {picture === false && <p class="hint">{words.noPicture}</p>}
        <div class="actions">
          {picture && (
            <button type="button" class={mayPlace ? 'button primary' : 'button'} onClick={() => setEditing(true)}>
              {mayPlace && !draft.landmarks ? words.place : words.landmarks}
            </button>
          )}
          {draft.landmarks && (
            <button type="button" class="button quiet" onClick={() => wish({ landmarks: null })}>
              {words.landmarksBack}
            </button>
          )}
        </div>
        <p class="hint" role="status">
          {hint()}
        </p>
      </section>
      <section class="panel" aria-label={words.motion}>
        <h3>{words.motion}</h3>
        <ChoiceFields value={draft} mayHaveSound={isFileId(job.inputs.driver)} onChange={wish} />
        <div class="field">
          <div class="checks">
            <Checkbox label={words.solid} checked={draft.solid} onChange={(solid) => wish({ solid })} />
          </div>
          <small>{words.solidHint}</small>
        </div>
        {job.inputs.driver && job.inputs.driver !== AUTO && (
          <>
            <DriverFaceField
              faces={Math.max(report?.inputs.driver_faces?.length ?? 1, asMade.driverFace + 1)}
              value={draft.driverFace}
              onChange={(driverFace) => wish({ driverFace })}
            />
            <TrimField value={draft.trim} onChange={(trim) => wish({ trim })} />
          </>
        )}
        {job.inputs.driver && sameFrames(draft, asMade) && (
          <NeutralFrame
            video={performanceUrl(job, report?.inputs.driver_chosen)}
            report={made.reactive ? null : report} // a profile's counts the frames of all its states
            start={made.trim?.[0] ?? 0}
            value={draft.neutral}
            onChange={(neutral) => wish({ neutral })}
          />
        )}
      </section>
      <section class="panel framing" aria-label={words.framing}>
        <h3>{words.framing}</h3>
        <SelectField
          label={words.crop}
          value={draft.crop}
          choices={crops}
          nameOf={(crop) => words.crops[crop]}
          onChange={(crop) => wish({ crop })}
        />
        <SizeField value={draft.size} own={words.sizeOwn} onChange={(size) => wish({ size })} />
        <RateField value={draft.rate} own={words.rateOwn} onChange={(rate) => wish({ rate })} />
        {!made.reactive && <FormatField value={draft.format} onChange={(format) => wish({ format })} />}
      </section>
      <div class="launch">
        <SubmitRow hint={again ? '' : strings.redo.unchanged} disabled={sending || !again} label={strings.redo.send} />
      </div>
      {editing && picture && (
        <LandmarkEditor
          url={picture.url}
          size={picture.size}
          found={before}
          onDone={place}
          onClose={() => setEditing(false)}
        />
      )}
    </form>
  );
}

const rounded = (value: number): number => Math.round(value * 100) / 100;

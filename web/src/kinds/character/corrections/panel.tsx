/** Everything about a character that can be put right by hand, and the order to make it again. */

import { useEffect, useMemo, useRef, useState } from 'preact/hooks';
import { type CharacterReport, foundPeople } from '../types';
import type { Pose } from '../../../viewer/posing/pose';
import { getSkeleton } from '../../../viewer/artifacts/skeleton';
import { later } from '../../../widgets/lazy';
import type { CorrectionsProps } from '../../../kind/kind';
import { SendingBar } from '../../../studio/sending_bar';
import { SubmitRow } from '../../../studio/submit_row';
import { usePicture } from '../../../result/use_picture';
import { randomKey } from '../../../api/idempotency';
import { useLoaded } from '../../../api/loading';
import { LoadingProblem } from '../../../widgets/problem_alert';
import { mayRepeat } from '../../../result/next_step';
import { strings } from '../../../language/strings';
import { forPerson, isChanged, isEverybody, type RevisionDraft, draftOf, revisionOf } from './changes';
import { CharacterFields, KeepField, VideoFields } from '../choices';
import { MotionField } from '../../../motion/motion_field';
import { MasksField } from '../masks/masks_field';
import { People } from '../people/people_picture';
import { useRevision } from '../../../sending/use_revision';
import { type Joints, jointsOf, middleOf, placedJoints, skeletonIn } from '../joints/skeleton';
import { words as characterWords } from '../words';
import '../../../styles/corrections.css';
import '../styles/character.css';

const JointEditor = later(() => import('../joints/joint_editor'));
const BoxEditor = later(() => import('../people/box_editor'));
const words = characterWords.correct;

export default function CharacterPanel({ job, report: told, proposal, onProposalTaken, onProblem }: CorrectionsProps) {
  const before = useMemo(() => draftOf(job), [job.id]);
  const [draft, setWishes] = useState<RevisionDraft>(before);
  const [editing, setEditing] = useState<'joints' | 'box' | null>(null);
  const key = useRef(randomKey());
  const report = told as CharacterReport | null;
  const read = useLoaded((signal) => getSkeleton(job, signal), job.id);
  const skeleton = read.value;
  const picture = usePicture(job, skeleton?.size ?? null);
  const people = report?.inputs.people ?? foundPeople(job);
  const mendable = job.error?.correctable ?? [];

  const wish = (part: Partial<RevisionDraft>): void => {
    key.current = randomKey(); // another wish is another order
    setWishes((known) => ({ ...known, ...part }));
  };
  const sending = useRevision(job, key, onProblem);
  const send = (wanted: RevisionDraft): void => {
    if (isChanged(before, wanted) || job.status !== 'succeeded') sending.send(revisionOf(job, before, wanted));
  };
  useEffect(() => {
    if (!proposal) return;
    const pose = proposal.pose as Pose; // from the viewer: it is to be made
    onProposalTaken();
    wish({ pose });
    send({ ...draft, pose }); // whatever else is wished for comes along
  }, [proposal]);

  const again = isChanged(before, draft) || mayRepeat(job);
  /** Whether the person is still the one that the job found. */
  const samePerson = draft.person === before.person && JSON.stringify(draft.box) === JSON.stringify(before.box);
  const together = isEverybody(draft);
  /** Whether there is an outline to be put right, or one was wanting. */
  const outlined = 'mask.png' in job.artifacts || mendable.some((name) => /^(mask|label)/.test(name));
  const found = useMemo<Joints | null>(
    () => (skeleton && samePerson && !together ? jointsOf(skeleton) : null),
    [skeleton, samePerson, together],
  );
  const placed = Object.keys(draft.joints).length;
  const shown = found || placed ? { ...found, ...draft.joints } : null;
  const start = useMemo<Joints | null>(() => {
    if (!picture) return null;
    const box = draft.box ?? (typeof draft.person === 'number' ? people[draft.person] : undefined);
    return { ...(found ?? skeletonIn(box ?? middleOf(picture.size))), ...draft.joints };
  }, [picture, found, draft.joints, draft.box, draft.person, report]);

  const jointsHint = (): string => {
    if (placed) return words.jointsPlaced(placed);
    return mendable.includes('joints') && !found ? words.jointsNeeded : words.jointsHint;
  };
  return (
    <form
      class="corrections character"
      onSubmit={(event) => {
        event.preventDefault();
        send(draft);
      }}
    >
      <section class="panel" aria-label={words.person}>
        <h3>{words.person}</h3>
        <LoadingProblem of={read} />
        {picture && (
          <People
            picture={picture}
            people={people}
            chosen={draft.box ? null : draft.person}
            box={draft.box}
            joints={shown}
            onChoose={(person) => wish(forPerson({ person }))}
          />
        )}
        {picture === false && <p class="hint">{words.noPicture}</p>}
        {!together && (
          <>
            <div class="actions">
              {picture && (
                <button
                  type="button"
                  class={mendable.includes('joints') && !placed ? 'button primary' : 'button'}
                  onClick={() => setEditing('joints')}
                >
                  {found || placed ? words.joints : words.placeJoints}
                </button>
              )}
              {placed > 0 && (
                <button type="button" class="button quiet" onClick={() => wish({ joints: {} })}>
                  {words.jointsBack}
                </button>
              )}
            </div>
            <p class="hint" role="status">
              {jointsHint()}
            </p>
          </>
        )}
        <div class="actions">
          {picture && (
            <button type="button" class="button" onClick={() => setEditing('box')}>
              {words.box}
            </button>
          )}
          {draft.box && (
            <button type="button" class="button quiet" onClick={() => wish(forPerson({ box: null }))}>
              {words.boxBack}
            </button>
          )}
        </div>
        <p class="hint">{draft.box ? words.boxPlaced : words.boxHint}</p>
      </section>
      <section class="panel" aria-label={words.move}>
        <h3>{words.move}</h3>
        <MotionField job={job} value={draft} before={before} onChange={wish} />
        <KeepField value={draft} onChange={wish} />
        {Object.keys(draft.pose).length > 0 && (
          <div class="actions">
            <p class="hint" role="status">
              {words.posed(Object.keys(draft.pose).length)} {together && words.posedAll}
            </p>
            <button type="button" class="button quiet" onClick={() => wish({ pose: {} })}>
              {words.poseBack}
            </button>
          </div>
        )}
      </section>
      <section class="panel framing" aria-label={words.video}>
        <h3>{words.video}</h3>
        <VideoFields value={draft} onChange={wish} />
      </section>
      <section class="panel framing" aria-label={words.character}>
        <h3>{words.character}</h3>
        <CharacterFields value={draft} onChange={wish} />
      </section>
      {picture && samePerson && !together && outlined && (
        <MasksField
          job={job}
          picture={picture}
          draft={draft}
          onPaint={wish}
        />
      )}
      <div class="launch">
        {sending.step ? (
          <SendingBar files={characterWords.files} step={sending.step} paused={sending.paused} onPause={sending.pause} onStop={sending.stop} />
        ) : (
          <SubmitRow hint={again ? '' : strings.redo.unchanged} disabled={sending.busy || !again} label={strings.redo.send} />
        )}
      </div>
      {editing === 'joints' && picture && start && (
        <JointEditor
          url={picture.url}
          size={picture.size}
          start={start}
          found={found !== null || placed > 0}
          onDone={(joints) => {
            setEditing(null);
            wish({ joints: placedJoints(joints, found, draft.joints, picture.size) });
          }}
          onClose={() => setEditing(null)}
        />
      )}
      {editing === 'box' && picture && (
        <BoxEditor
          url={picture.url}
          size={picture.size}
          start={draft.box ?? (typeof draft.person === 'number' ? people[draft.person] : null) ?? middleOf(picture.size)}
          onDone={(box) => {
            setEditing(null);
            wish(forPerson({ box }));
          }}
          onClose={() => setEditing(null)}
        />
      )}
    </form>
  );
}

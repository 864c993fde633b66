/** Everything about an avatar that can be put right by hand, and the order to make it again. */

import { useMemo, useRef, useState } from 'preact/hooks';
import { readArtifact } from '../../../api';
import { randomKey } from '../../../api/idempotency';
import { useLoaded } from '../../../api/loading';
import type { CorrectionsProps } from '../../../kind/kind';
import { strings } from '../../../language/strings';
import { MotionField } from '../../../motion/motion_field';
import { mayRepeat } from '../../../result/next_step';
import { useRevision } from '../../../sending/use_revision';
import { SendingBar } from '../../../studio/sending_bar';
import { SubmitRow } from '../../../studio/submit_row';
import { DriverField } from '../driver_field';
import { heightIn } from '../height';
import { HeightField } from '../height_field';
import { AvatarOptionFields } from '../option_fields';
import { clipNames, type FrameSheets } from '../types';
import { words as avatarWords } from '../words';
import { draftOf, isChanged, type RevisionDraft, revisionOf } from './changes';
import { FramesField } from './frames_field';
import { LandmarksField } from './landmarks_field';
import '../../../styles/corrections.css';
import '../styles/corrections.css';

const words = avatarWords.correct;

export default function AvatarPanel({ job, onProblem }: CorrectionsProps) {
  const before = useMemo(() => draftOf(job), [job.id]);
  const [draft, setDraft] = useState(before);
  const [refused, setRefused] = useState(false);
  const key = useRef(randomKey());
  const sheets = useLoaded((signal) => readArtifact<FrameSheets>(job, 'frames.json', signal), job.id).value;
  const sending = useRevision(job, key, onProblem);
  const wish = (part: Partial<RevisionDraft>): void => {
    key.current = randomKey(); // another wish is another order
    setDraft((known) => ({ ...known, ...part }));
  };
  const again = isChanged(before, draft) || mayRepeat(job);
  const wrong = Number.isNaN(heightIn(draft.height));
  return (
    <form
      class="corrections avatar"
      onSubmit={(event) => {
        event.preventDefault();
        if (again && !wrong) sending.send(revisionOf(job, before, draft));
      }}
    >
      {!job.inputs.avatar && ( // which was measured by another job
        <section class="panel" aria-label={words.person}>
          <h3>{words.person}</h3>
          <HeightField value={draft.height} onChange={(height) => wish({ height })} />
          {sheets?.body && (
            <LandmarksField job={job} sheet={sheets.body} value={draft.landmarks} onChange={(landmarks) => wish({ landmarks })} />
          )}
        </section>
      )}
      <section class="panel" aria-label={words.animation}>
        <h3>{words.animation}</h3>
        <MotionField job={job} value={draft} before={before} onChange={wish} />
        <h4>{words.driver}</h4>
        {draft.driver === 'held' && <p class="hint">{words.driverKept}</p>}
        <DriverField
          file={draft.driver instanceof File ? draft.driver : null}
          refused={refused}
          onFile={(file) => {
            setRefused(false);
            wish({ driver: file ?? before.driver });
          }}
          onRefused={() => {
            setRefused(true);
            wish({ driver: before.driver });
          }}
        />
        {draft.driver === 'held' && (
          <button type="button" class="button quiet" onClick={() => wish({ driver: null })}>
            {words.driverBack}
          </button>
        )}
      </section>
      {clipNames.map((clip) => {
        const sheet = sheets?.[clip];
        const url = sheet && job.artifacts[sheet.sheet]?.url;
        return (
          sheet &&
          url && (
            <FramesField
              key={clip}
              sheet={sheet}
              url={url}
              title={words.frames[clip]}
              leftOut={draft.leftOut[clip]}
              onChange={(leftOut) => wish({ leftOut: { ...draft.leftOut, [clip]: leftOut } })}
            />
          )
        );
      })}
      <section class="panel whole" aria-label={words.options}>
        <details class="choices">
          <summary>{words.options}</summary>
          <AvatarOptionFields value={draft.options} onChange={(options) => wish({ options })} />
        </details>
      </section>
      <div class="launch">
        {sending.step ? (
          <SendingBar files={avatarWords.files} step={sending.step} paused={sending.paused} onPause={sending.pause} onStop={sending.stop} />
        ) : (
          <SubmitRow
            hint={wrong ? avatarWords.studio.wrongHeight : again ? '' : strings.redo.unchanged}
            disabled={sending.busy || !again || wrong}
            label={strings.redo.send}
          />
        )}
      </div>
    </form>
  );
}

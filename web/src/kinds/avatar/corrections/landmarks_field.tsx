/** Joints that are shown by hand: how many there are, and the window in which they are placed. */

import { useState } from 'preact/hooks';
import type { Job } from '../../../api';
import { later } from '../../../widgets/lazy';
import { fileUrl, isFileId } from '../../../works/inputs';
import type { FrameSheet } from '../types';
import { words as avatarWords } from '../words';
import { MIN_LANDMARK_FRAMES, type Landmarks, placedIn } from './changes';
import { landmarkName } from './landmarks';

const LandmarkDialog = later(() => import('./landmark_dialog'));
const words = avatarWords.correct;

interface Props {
  job: Job;
  sheet: FrameSheet;
  value: Landmarks;
  onChange: (landmarks: Landmarks) => void;
}

export function LandmarksField({ job, sheet, value, onChange }: Props) {
  const [open, setOpen] = useState(false);
  const needed = job.error?.correctable?.includes('landmarks') ?? false;
  const doubtful = (job.error?.found as { doubtful?: string[] } | undefined)?.doubtful ?? [];
  const once = Object.keys(value).filter((joint) => (value[joint]?.length ?? 0) < MIN_LANDMARK_FRAMES);
  const placed = Object.keys(placedIn(value)).length;
  const url = job.artifacts[sheet.sheet]?.url;
  const { body } = job.inputs;
  const list = (joints: readonly string[]): string => joints.map(landmarkName).join(', ');
  return (
    <>
      <h4>{words.joints}</h4>
      <p class="hint" role="status">
        {placed > 0 ? words.placed(placed) : needed ? words.jointsNeeded : words.jointsHint}{' '}
        {once.length > 0 && words.once(list(once))} {doubtful.length > 0 && words.doubtful(list(doubtful))}
      </p>
      <div class="actions">
        {url && (
          <button type="button" class={needed && placed === 0 ? 'button primary' : 'button'} onClick={() => setOpen(true)}>
            {words.placeJoints}
          </button>
        )}
        {Object.keys(value).length > 0 && (
          <button type="button" class="button quiet" onClick={() => onChange({})}>
            {words.jointsBack}
          </button>
        )}
      </div>
      {open && url && (
        <LandmarkDialog
          sheet={sheet}
          sheetUrl={url}
          clip={isFileId(body) ? fileUrl(body) : null}
          doubtful={doubtful}
          start={value}
          onDone={(landmarks) => {
            setOpen(false);
            onChange(landmarks);
          }}
          onClose={() => setOpen(false)}
        />
      )}
    </>
  );
}

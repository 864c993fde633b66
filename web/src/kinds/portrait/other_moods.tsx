/** One click shows the portrait of a job in another mood. */

import type { Job } from '../../api';
import { useKind } from '../../kind/kinds';
import { OtherPerformances } from '../../performances/other_performances';
import { labelOf } from '../../performances/performance_card';
import { isFileId } from '../../works/inputs';
import { pictureName } from '../../works/names';
import { type PortraitOptions, portraitOptions } from './types';
import { words as portraitWords } from './words';

/** What belongs to the picture and the video, and so goes along; the rest is of the performance. */
const KEPT = ['size', 'fps', 'format', 'face_index', 'strength', 'follow', 'head_3d', 'crop', 'loop', 'landmarks'] as const;

export const carriedOver = (options: PortraitOptions): PortraitOptions =>
  Object.fromEntries(KEPT.filter((name) => name in options).map((name) => [name, options[name]]));

export function OtherMoods({ job }: { job: Job }) {
  const kind = useKind(job.kind);
  const { image, driver: played } = job.inputs;
  if (!isFileId(image)) return null;
  return (
    <OtherPerformances
      title={portraitWords.result.moods}
      kind="portrait"
      played={played}
      request={(driver) => ({
        inputs: { image, driver: driver.name },
        options: carriedOver(portraitOptions(job)),
        metadata: { portrait: pictureName(job, kind), performance: labelOf(driver) },
      })}
    />
  );
}

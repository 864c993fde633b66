/** What was cut out, and what belongs to which part of the body, to be painted over where it is wrong. */

import { useState } from 'preact/hooks';
import type { CharacterOptions, Job } from '../api';
import type { Shown } from '../components/boxed';
import { later } from '../components/later';
import { strings } from '../strings';
import type { Wishes } from './changes';
import { Painting } from './painting';
import type { LabelStroke, MaskStroke } from './strokes';
import '../styles/painter.css';

const Painter = later(() => import('./painter'));
const words = strings.correct;

interface Props {
  job: Job;
  picture: Shown;
  made: CharacterOptions;
  mask: readonly MaskStroke[];
  labels: readonly LabelStroke[];
  onPaint: (painted: Partial<Pick<Wishes, 'mask' | 'labels'>>) => void;
}

/** Nothing where the job left no mask to paint over. */
export function Paintings({ job, picture, made, mask, labels, onPaint }: Props) {
  const [what, setWhat] = useState<'mask' | 'labels' | null>(null);
  const [found, parts] = [job.artifacts['mask.png']?.url, job.artifacts['labels.png']?.url];
  if (!found || !parts) return null;
  // what the job itself was given is in its mask and labels already
  const [madeMask, madeLabels] = [made.mask_strokes ?? [], made.label_strokes ?? []];
  const fresh = {
    mask: mask.filter((stroke) => !madeMask.includes(stroke)),
    labels: labels.filter((stroke) => !madeLabels.includes(stroke)),
  };
  const held = {
    mask: mask.filter((stroke) => madeMask.includes(stroke)),
    labels: labels.filter((stroke) => madeLabels.includes(stroke)),
  };
  const shown = { url: picture.url, size: picture.size, mask: found, labels: parts };
  const tasks = [
    { of: 'mask', title: words.mask, hint: mask.length ? words.maskPainted : words.maskHint },
    { of: 'labels', title: words.labels, hint: labels.length ? words.labelsPainted : words.labelsHint },
  ] as const;
  const [width, height] = picture.size;
  return (
    <section class="panel paintings" aria-label={words.paint}>
      <h3>{words.paint}</h3>
      {tasks.map(({ of, title, hint }) => (
        <div key={of} class="painted">
          <div class="boxed" style={{ aspectRatio: `${width} / ${height}`, '--aspect': width / height }}>
            <svg viewBox={`-0.5 -0.5 ${width} ${height}`} aria-hidden="true">
              <Painting {...shown} what={of} strokes={fresh} />
            </svg>
          </div>
          <p class="hint" role="status">
            {hint}
          </p>
          <div class="actions">
            <button type="button" class="button" onClick={() => setWhat(of)}>
              {title}
            </button>
            {(of === 'mask' ? mask : labels).length > 0 && (
              <button type="button" class="button quiet" onClick={() => onPaint({ [of]: [] })}>
                {words.paintBack}
              </button>
            )}
          </div>
        </div>
      ))}
      {what && (
        <Painter
          {...shown}
          what={what}
          fresh={fresh}
          onDone={(strokes) => {
            setWhat(null);
            onPaint({ [what]: [...held[what], ...strokes] });
          }}
          onClose={() => setWhat(null)}
        />
      )}
    </section>
  );
}

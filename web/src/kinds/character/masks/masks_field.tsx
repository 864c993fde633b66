/** What was cut out, and what belongs to which part of the body: painted over where it is wrong, or given as a file. */

import { useEffect, useId, useState } from 'preact/hooks';
import type { Job } from '../../../api';
import { characterOptions } from '../types';
import type { SizedPicture } from '../../../widgets/boxed_picture';
import { FileButton } from '../../../widgets/file_button';
import { later } from '../../../widgets/lazy';
import { maskTypes } from '../../../studio/given_files/media_types';
import type { RevisionDraft } from '../corrections/changes';
import { type MaskFault, faultOf, type Painted, previewOf, sizeOf } from './mask_file';
import { MaskOverlay } from './mask_overlay';
import { words as characterWords } from '../words';
import '../styles/mask_editor.css';

const MaskEditor = later(() => import('./mask_editor'));
const words = characterWords.correct;

interface Props {
  job: Job;
  picture: SizedPicture;
  draft: RevisionDraft;
  onPaint: (painted: Partial<Pick<RevisionDraft, 'mask' | 'labels' | 'maskFile' | 'labelsFile'>>) => void;
}

const fileNames = { mask: 'maskFile', labels: 'labelsFile' } as const;

export function MasksField({ job, picture, draft, onPaint }: Props) {
  const [what, setWhat] = useState<Painted | null>(null);
  const { mask, labels, maskFile, labelsFile } = draft;
  const found = job.artifacts['mask.png']?.url ?? null;
  // a file that was only just chosen shows what is read in it; what the job had is in its mask and labels already
  const shown = {
    ...{ url: picture.url, size: picture.size },
    mask: useRead(maskFile, 'mask') ?? found,
    labels: useRead(labelsFile, 'labels') ?? job.artifacts['labels.png']?.url ?? null,
  };
  const made = characterOptions(job);
  const [madeMask, madeLabels] = [made.mask_strokes ?? [], made.label_strokes ?? []];
  const fresh = {
    mask: mask.filter((stroke) => !madeMask.includes(stroke)),
    labels: labels.filter((stroke) => !madeLabels.includes(stroke)),
  };
  const held = {
    mask: mask.filter((stroke) => madeMask.includes(stroke)),
    labels: labels.filter((stroke) => madeLabels.includes(stroke)),
  };
  /** As large as the picture, or as what was found in it: that may be worked on and given back. */
  const sizes = async () => {
    const own = found ? await fetch(found).then(async (got) => sizeOf(await got.blob())).catch(() => null) : null;
    return own ? [picture.size, own] : [picture.size];
  };
  const [width, height] = picture.size;
  return (
    <section class="panel masks" aria-label={words.paint}>
      <h3>{words.paint}</h3>
      {(['mask', 'labels'] as const).map((of) => {
        const file = draft[fileNames[of]];
        const painted = draft[of].length > 0;
        const ready = shown.mask !== null && shown[of] !== null;
        return (
          <div key={of} class="painted">
            <div class="boxed" style={{ aspectRatio: `${width} / ${height}`, '--aspect': width / height }}>
              <svg viewBox={`-0.5 -0.5 ${width} ${height}`} aria-hidden="true">
                <MaskOverlay {...shown} what={shown[of] === null ? null : of} strokes={fresh} />
              </svg>
            </div>
            <p class="hint" role="status">
              {file ? words.fileGiven(file instanceof File ? file.name : null) : ''}{' '}
              {painted ? words.painted[of] : file ? '' : words.paintHint[of]}
            </p>
            <div class="actions">
              {ready && (
                <button type="button" class="button" onClick={() => setWhat(of)}>
                  {words[of]}
                </button>
              )}
              <FromFile
                name={words.fileFor[of]}
                sizes={sizes}
                onFile={(given) => onPaint({ [fileNames[of]]: given, [of]: [] })}
              />
              {(painted || file) && (
                <button
                  type="button"
                  class="button quiet"
                  onClick={() => onPaint({ [fileNames[of]]: null, [of]: [] })}
                >
                  {file ? words.fileBack : words.paintBack}
                </button>
              )}
            </div>
          </div>
        );
      })}
      {what && shown.mask !== null && shown.labels !== null && (
        <MaskEditor
          {...shown}
          what={what}
          mask={shown.mask}
          labels={shown.labels}
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

interface FromFileProps {
  name: string;
  sizes: () => Promise<(readonly [number, number])[]>;
  onFile: (file: File) => void;
}

/** A file in place of what was found; one that does not fit is refused, and why. */
function FromFile({ name, sizes, onFile }: FromFileProps) {
  const id = useId();
  const [refused, setRefused] = useState<string | null>(null);
  const take = async (file: File): Promise<void> => {
    const allowed = await sizes();
    const misfit = await faultOf(file, allowed);
    setRefused(misfit && whyNot(file, misfit, allowed));
    if (!misfit) onFile(file);
  };
  return (
    <>
      <FileButton
        label={words.fromFile}
        name={name}
        accept={maskTypes}
        error={refused === null ? undefined : id}
        onFile={(file) => void take(file)}
      />
      {refused !== null && (
        <p class="error" role="alert" id={id}>
          {refused}
        </p>
      )}
    </>
  );
}

function whyNot(file: File, misfit: MaskFault, allowed: (readonly [number, number])[]): string {
  if (misfit.why === 'unreadable') return words.fileUnreadable(file.name);
  const told = [...new Set(allowed.map(([width, height]) => words.pixels(width, height)))];
  return words.fileSize(file.name, words.pixels(...misfit.size), told.join(words.or));
}

/** Where a picture is of what is read in a file; null without one, and until it is read. */
function useRead(given: RevisionDraft['maskFile'], what: Painted): string | null {
  const file = given instanceof File ? given : null;
  const [url, setUrl] = useState<string | null>(null);
  useEffect(() => {
    if (!file) return;
    let made: string | null = null;
    let current = true;
    void previewOf(file, what).then((read) => {
      if (current) setUrl((made = URL.createObjectURL(read)));
    });
    return () => {
      current = false;
      setUrl(null);
      if (made) URL.revokeObjectURL(made);
    };
  }, [file, what]);
  return url;
}

/** The place of a clip, and beside it how it is filmed. */

import type { ComponentType } from 'preact';
import { useId } from 'preact/hooks';
import { isVideo, videoTypes } from '../../../studio/given_files/media_types';
import { Dropzone } from '../../../widgets/dropzone';
import { words as avatarWords } from '../words';
import { BodyOrbits, HeadOrbits } from './orbits';

const words = avatarWords.studio;

export type Clip = keyof typeof words.clips;

const drawings: Record<Clip, ComponentType<{ label: string }>> = { body: BodyOrbits, head: HeadOrbits };

interface Props {
  clip: Clip;
  file: File | null;
  /** Whether what was given last was no video. */
  refused: boolean;
  /** What is said where the clip may be left out. */
  optional?: string;
  onFile: (file: File | null) => void;
  onRefused: () => void;
}

export function ClipPanel({ clip, file, refused, optional, onFile, onRefused }: Props) {
  const id = useId();
  const own = words.clips[clip];
  const Orbits = drawings[clip];
  return (
    <section class="panel clip" aria-labelledby={id}>
      <div class="clip-place">
        <h2 id={id}>{own.title}</h2>
        <p class="hint">{own.hint}</p>
        <Dropzone
          media="video"
          file={file}
          accept={videoTypes}
          accepts={isVideo}
          words={{ drop: own.drop, browse: own.browse, chosen: own.chosen, wrong: words.wrongClip }}
          onFile={onFile}
          refused={refused}
          onRefused={onRefused}
        />
        {optional && !file && <p class="hint">{optional}</p>}
        {optional && file && (
          <button type="button" class="button quiet" onClick={() => onFile(null)}>
            {words.remove}
          </button>
        )}
      </div>
      <div class="clip-guide">
        <Orbits label={own.drawing} />
        <ol>
          {own.steps.map((step) => (
            <li key={step}>{step}</li>
          ))}
        </ol>
      </div>
    </section>
  );
}

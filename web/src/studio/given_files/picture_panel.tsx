/** Where the picture of an order is given: one to try, a file of one's own, or one that the camera takes. */

import { useId } from 'preact/hooks';
import { strings } from '../../language/strings';
import { Dropzone } from '../../widgets/dropzone';
import { Capture } from './capture';
import { isPicture, pictureTypes } from './media_types';
import type { SamplePicture } from '../samples/sample_pictures';
import { Samples } from '../samples/samples';

const words = strings.studio;

interface Props {
  title: string;
  hint: string;
  samples: readonly SamplePicture[];
  /** How much of somebody the camera is to see. */
  of: 'face' | 'body';
  file: File | null;
  chosenLabel: (name: string) => string;
  /** Whether what was given last was no picture. */
  refused: boolean;
  onFile: (file: File) => void;
  onRefused: () => void;
}

export function PicturePanel({ title, hint, samples, of, file, chosenLabel, refused, onFile, onRefused }: Props) {
  const id = useId();
  return (
    <div class="beside">
      <section class="panel" aria-labelledby={id}>
        <h2 id={id}>{title}</h2>
        <p class="hint">{hint}</p>
        <Samples samples={samples} chosen={file} onChoose={onFile} />
        <Dropzone
          media="image"
          file={file}
          accept={pictureTypes}
          accepts={isPicture}
          words={{ drop: words.pictureDrop, browse: words.pictureBrowse, chosen: chosenLabel, wrong: words.wrongPicture }}
          onFile={onFile}
          refused={refused}
          onRefused={onRefused}
        />
        <Capture media="image" of={of} onFile={onFile} />
      </section>
    </div>
  );
}

/** Whose face the avatar's follows: a video of one, or a recording. */

import { Capture } from '../../studio/given_files/capture';
import { isVideo, videoTypes } from '../../studio/given_files/media_types';
import { Dropzone } from '../../widgets/dropzone';
import { words as avatarWords } from './words';

const words = avatarWords.studio;

interface Props {
  file: File | null;
  refused: boolean;
  onFile: (file: File | null) => void;
  onRefused: () => void;
}

export function DriverField({ file, refused, onFile, onRefused }: Props) {
  return (
    <>
      <Dropzone
        media="video"
        file={file}
        accept={videoTypes}
        accepts={isVideo}
        words={{ drop: words.driverDrop, browse: words.driverBrowse, chosen: words.driverChosen, wrong: words.wrongDriver }}
        onFile={onFile}
        refused={refused}
        onRefused={onRefused}
      />
      <div class="actions">
        <Capture media="video" onFile={onFile} />
        {file && (
          <button type="button" class="button quiet" onClick={() => onFile(null)}>
            {words.removeDriver}
          </button>
        )}
      </div>
    </>
  );
}

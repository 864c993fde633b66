/** The place for a motion's file. */

import { Dropzone } from '../widgets/dropzone';
import { isMotion, motionTypes } from '../studio/given_files/media_types';
import { words } from './words';

interface Props {
  file: File | null;
  onFile: (file: File) => void;
  refused: boolean;
  onRefused: () => void;
}

export function MotionDropzone({ file, onFile, refused, onRefused }: Props) {
  return (
    <Dropzone
      media="motion"
      file={file}
      accept={motionTypes}
      accepts={isMotion}
      words={{
        drop: words.drop,
        browse: words.browse,
        chosen: words.chosen,
        wrong: words.wrong,
      }}
      onFile={onFile}
      refused={refused}
      onRefused={onRefused}
    />
  );
}

/** Further clips of the person: of what the body's clip shows too little of. */

import { FileList } from '../../studio/given_files/file_list';
import { isVideo, videoTypes } from '../../studio/given_files/media_types';
import { Dropzone } from '../../widgets/dropzone';
import { words as avatarWords } from './words';

const words = avatarWords.studio.further;

/** As many as the service takes. */
export const MAX_FURTHER_CLIPS = 4;

interface Props {
  files: readonly File[];
  /** Whether what was given last was no video. */
  refused: boolean;
  onAdded: (file: File) => void;
  onRemoved: (file: File) => void;
  onRefused: () => void;
}

export function FurtherClips({ files, refused, onAdded, onRemoved, onRefused }: Props) {
  return (
    <details class="choices further" open={files.length > 0 || refused}>
      <summary>{words.title}</summary>
      <p class="hint">{words.hint}</p>
      <FileList
        files={files}
        removeWord={words.removeWord}
        removeLabel={words.remove}
        onRemove={onRemoved}
      />
      {files.length < MAX_FURTHER_CLIPS && (
        <Dropzone
          media="video"
          file={null}
          accept={videoTypes}
          accepts={isVideo}
          words={{ drop: files.length ? words.another : words.drop, browse: words.browse, chosen: words.remove, wrong: words.wrong }}
          onFile={onAdded}
          refused={refused}
          onRefused={onRefused}
        />
      )}
    </details>
  );
}

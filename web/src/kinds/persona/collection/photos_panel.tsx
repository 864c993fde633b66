/** The photos of an order: dropped, browsed for, or a folder at once; each can be taken away again. */

import { useId, useState } from 'preact/hooks';
import { size } from '../../../language/format';
import { Capture } from '../../../studio/given_files/capture';
import { collected, type Collected, collectedFrom } from '../../../studio/given_files/collection';
import { archiveTypes, pictureTypes } from '../../../studio/given_files/media_types';
import { DropTarget, Invitation } from '../../../widgets/drop_target';
import { Refusal } from '../../../widgets/dropzone';
import { FolderButton } from '../../../widgets/folder_button';
import { words as personaWords } from '../words';
import { isArchive } from './photo_files';
import { PhotoTiles } from './photo_tiles';
import type { Giving } from './use_giving';

const words = personaWords.studio;

interface Props {
  /** What is asked for, and what the place says while it is empty, and when it is not. */
  words: { hint: string; drop: string; more: string };
  /** As many as are needed at least. */
  least: number;
  photos: readonly Collected[];
  /** How many of the files that were given last were none. */
  others: number;
  /** There was none among what was given last. */
  refused: boolean;
  giving: Giving;
  onRemoved: (photo: Collected) => void;
  onCleared: () => void;
}

export function PhotosPanel({ words: asked, least, photos, others, refused, giving, onRemoved, onCleared }: Props) {
  const error = useId();
  const [tries, setTries] = useState(0);
  const give = (files: Promise<readonly Collected[]>): void => {
    setTries(tries + 1);
    giving.give(files);
  };
  const drop = photos.length ? asked.more : asked.drop;
  const missing = photos.some(isArchive) ? 0 : least - photos.length;
  const bytes = photos.reduce((sum, { file }) => sum + file.size, 0);
  return (
    <>
      <p class="hint">{asked.hint}</p>
      <DropTarget
        class="video"
        accept={`${pictureTypes},${archiveTypes}`}
        many
        label={`${drop} ${words.browse}`}
        error={refused ? error : undefined}
        onDrop={(data) => give(collectedFrom(data))}
        onBrowse={(files) => give(Promise.resolve(collected(files)))}
      >
        {refused ? <Refusal key={tries} id={error} wrong={words.wrong} browse={words.browse} /> : <Invitation drop={drop} browse={words.browse} />}
      </DropTarget>
      <div class="actions">
        <FolderButton label={words.folder} onFiles={(files) => give(Promise.resolve(collected(files)))} />
        <Capture media="image" onFile={(file) => give(Promise.resolve(collected([file])))} />
        {photos.length > 1 && (
          <button type="button" class="button quiet" onClick={onCleared}>
            {words.removeAll}
          </button>
        )}
      </div>
      <p class="hint" role="status" aria-busy={giving.reading}>
        {giving.reading
          ? words.reading
          : photos.length > 0 &&
            [words.chosen(photos.length, size(bytes)), missing > 0 && words.few(missing), others > 0 && words.others(others)]
              .filter(Boolean)
              .join(' · ')}
      </p>
      <PhotoTiles photos={photos} onRemoved={onRemoved} />
    </>
  );
}

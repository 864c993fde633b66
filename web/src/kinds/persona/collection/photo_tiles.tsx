/** The files of a collection as small pictures; a click takes one away. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { type Collected, identity } from '../../../studio/given_files/collection';
import { Thumbnail } from '../../../studio/given_files/thumbnail';
import { words as personaWords } from '../words';
import { isArchive } from './photo_files';

const words = personaWords.studio;

interface Props {
  photos: readonly Collected[];
  onRemoved: (photo: Collected) => void;
}

export function PhotoTiles({ photos, onRemoved }: Props) {
  const list = useRef<HTMLUListElement>(null);
  const [gone, setGone] = useState<{ name: string; place: number } | null>(null);
  // The button that had the focus went with its tile: the one that is in its place now has it.
  useEffect(() => {
    if (gone) list.current?.querySelectorAll('button')[Math.min(gone.place, photos.length - 1)]?.focus();
  }, [gone]);
  return (
    <>
      <p class="visually-hidden" role="status">
        {gone && words.removed(gone.name)}
      </p>
      {photos.length > 0 && (
        <ul ref={list} class="photo-tiles" aria-label={words.files}>
          {photos.map((photo, place) => (
            <li key={identity(photo)} title={photo.path}>
              {isArchive(photo) ? (
                <span class="unseen" aria-hidden="true">
                  {words.archive}
                </span>
              ) : (
                <Thumbnail file={photo.file} instead={words.noPreview} />
              )}
              <button
                type="button"
                aria-label={words.remove(photo.file.name)}
                onClick={() => {
                  onRemoved(photo);
                  setGone({ name: photo.file.name, place });
                }}
              >
                <svg viewBox="0 0 24 24" width="16" height="16" aria-hidden="true">
                  <path d="M6 6l12 12M18 6 6 18" />
                </svg>
              </button>
              {isArchive(photo) && <span class="name">{photo.file.name}</span>}
            </li>
          ))}
        </ul>
      )}
    </>
  );
}

/** Photos of who performs: they tell what that face is like at rest. */

import type { Collected } from '../../../studio/given_files/collection';
import { MIN_PERFORMER_PHOTOS } from '../types';
import { words as personaWords } from '../words';
import { PhotosPanel } from './photos_panel';
import { useGiving } from './use_giving';

const words = personaWords.studio.performer;

interface Props {
  photos: readonly Collected[];
  refused: boolean;
  onAdded: (photos: readonly Collected[]) => void;
  onRefused: () => void;
  onRemoved: (photo: Collected) => void;
  onCleared: () => void;
}

export function PerformerPhotos({ photos, refused, onAdded, onRefused, onRemoved, onCleared }: Props) {
  const giving = useGiving(({ photos }) => onAdded(photos), onRefused);
  return (
    <details class="choices" open={photos.length > 0 || refused}>
      <summary>{words.title}</summary>
      <div class="performer">
        <PhotosPanel
          words={words}
          least={MIN_PERFORMER_PHOTOS}
          photos={photos}
          others={0}
          refused={refused}
          giving={giving}
          onRemoved={onRemoved}
          onCleared={onCleared}
        />
      </div>
    </details>
  );
}

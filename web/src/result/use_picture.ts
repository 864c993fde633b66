/** The picture of a job as it was sent, to be worked on. */

import { useEffect, useState } from 'preact/hooks';
import type { Job } from '../api';
import { useKind } from '../kind/kinds';
import type { SizedPicture } from '../widgets/boxed_picture';
import { pictureUrl } from '../works/names';

/**
 * A picture to work on: the portrait itself, or, where this browser cannot show it (HEIC), the preview in its place.
 * Null while it is loaded; false where there is nothing to show. A preview that was cut out of it cannot stand in for it.
 */
export function usePicture(job: Job, original: readonly [number, number] | null, isPreviewCropped = false): SizedPicture | false | null {
  const kind = useKind(job.kind);
  const [shown, setShown] = useState<SizedPicture | false | null>(null);
  useEffect(() => {
    let current = true;
    const preview = isPreviewCropped ? undefined : job.artifacts['preview.jpg']?.url;
    const sent = pictureUrl(job, kind);
    const show = (url: string, instead: () => void): void => {
      const image = new Image();
      image.onload = () => current && setShown({ url, size: original ?? [image.naturalWidth, image.naturalHeight] });
      image.onerror = () => current && instead();
      image.src = url;
    };
    const nothing = (): void => setShown(false);
    const usePreview = (): void => (preview && original ? show(preview, nothing) : nothing());
    if (sent) show(sent, usePreview);
    else usePreview();
    return () => {
      current = false;
    };
  }, [job.id, original?.[0], original?.[1]]);
  return shown;
}

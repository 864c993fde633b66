/** What a face is to act out: a performance that the service has, or a video at hand. */

import { fileTitle } from '../language/format';
import { plain } from '../language/strings';

export type Performance = { by: 'name'; name: string } | { by: 'file'; file: File };

/** Whether a file that was chosen is a picture; a GIF moves. */
export const isStill = ({ type }: File): boolean => type.startsWith('image/') && type !== 'image/gif';

export const performanceTitle = (performance: Performance): string =>
  performance.by === 'name' ? plain(performance.name) : fileTitle(performance.file);

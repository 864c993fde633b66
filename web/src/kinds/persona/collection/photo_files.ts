/** Which of the files that are given are photos, or archives of photos: told by what is in them. */

import { type Collected } from '../../../studio/given_files/collection';
import { mediaIn } from '../../../studio/given_files/media_types';

/** Files that are looked into at once: a browser opens no more of them at a time than it has to. */
const AT_ONCE = 16;

export interface Given {
  photos: readonly Collected[];
  /** How many other files there were. */
  others: number;
}

/** Hidden files are nobody's photos, and are not counted either. */
const isHidden = ({ path }: Collected): boolean => path.split('/').some((name) => name.startsWith('.') || name === '__MACOSX');

export async function photosAmong(files: readonly Collected[]): Promise<Given> {
  const seen = files.filter((one) => !isHidden(one));
  const photos: Collected[] = [];
  for (let start = 0; start < seen.length; start += AT_ONCE) {
    const some = seen.slice(start, start + AT_ONCE);
    const media = await Promise.all(some.map(({ file }) => mediaIn(file)));
    photos.push(...some.filter((_one, place) => media[place] === 'picture' || media[place] === 'archive'));
  }
  return { photos, others: seen.length - photos.length };
}

/** By its name, which is enough for a drawing: what it is was told by its bytes. */
export const isArchive = ({ file }: Collected): boolean => /\.(zip|tar|tgz|gz|bz2|xz)$/i.test(file.name);

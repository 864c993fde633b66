/** An order of a persona: photos, or one that was made before, and what it is to play. */

import type { JobRequest } from '../../api';
import { randomKey } from '../../api/idempotency';
import type { Order, OrderNames, Upload } from '../../kind/kind';
import { stem } from '../../language/format';
import { plain } from '../../language/strings';
import { type Performance, performanceTitle } from '../../performances/performance';
import { type Collected, commonFolder } from '../../studio/given_files/collection';
import { words as personaWords } from './words';

/** A persona that was made before. */
export interface Earlier {
  /** Of the job that made it. */
  id: string;
  name: string;
}

export type Source = { by: 'photos'; photos: readonly Collected[] } | ({ by: 'persona' } & Earlier);

export interface PersonaOrder extends Order {
  kind: 'persona';
  source: Source;
  /** Null: it is made, and plays nothing. */
  performance: Performance | null;
  /** Photos of who performs. */
  performer: readonly Collected[];
  /** What the puppet stands before, instead of a plain colour. */
  backdrop?: File | null;
  options: object;
}

export const personaOrder = (given: Pick<PersonaOrder, 'source' | 'performance' | 'performer' | 'backdrop' | 'options'>): PersonaOrder => ({
  ...given,
  kind: 'persona',
  ...{ key: randomKey(), sent: {} },
});

/** Of photos: their folder's name, or the archive's, or how many they are. */
function sourceName(source: Source): string {
  if (source.by === 'persona') return source.name;
  const { photos } = source;
  const folder = commonFolder(photos);
  if (folder !== null) return plain(folder);
  return photos.length === 1 ? plain(stem(photos[0]!.file.name)) : personaWords.photos(photos.length);
}

export const namesOf = ({ source, performance }: PersonaOrder): OrderNames => ({
  picture: sourceName(source),
  performance: performance ? performanceTitle(performance) : personaWords.noPerformance,
});

export async function request(order: PersonaOrder, upload: Upload): Promise<JobRequest> {
  const { source, performance, performer, backdrop, options } = order;
  const inputs: JobRequest['inputs'] = {};
  if (source.by === 'persona') inputs.persona = source.id;
  else inputs.photos = await sentOneByOne(source.photos, 'photos', upload);
  if (performance) inputs.driver = performance.by === 'name' ? performance.name : await upload(performance.file, 'driver');
  if (performance && performer.length) inputs.driver_photos = await sentOneByOne(performer, 'driver_photos', upload);
  if (performance && backdrop) inputs.background_picture = await upload(backdrop, 'background_picture');
  const names = namesOf(order);
  return { inputs, options, metadata: { picture: names.picture, ...(performance && { performance: names.performance }) } };
}

async function sentOneByOne(all: readonly Collected[], part: string, upload: Upload): Promise<string[]> {
  const ids: string[] = [];
  for (const [index, { file }] of all.entries()) ids.push(await upload(file, part, { number: index + 1, count: all.length }));
  return ids;
}

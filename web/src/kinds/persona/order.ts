/** An order of a persona: photos, or one that was made before, and what it is to play. */

import type { JobRequest } from '../../api';
import { randomKey } from '../../api/idempotency';
import type { Order, OrderNames, Upload } from '../../kind/kind';
import { stem } from '../../language/format';
import { plain } from '../../language/strings';
import { type Performance, performanceTitle } from '../../performances/performance';
import { type Collected, commonFolder } from '../../studio/collection';
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
  options: object;
}

export const personaOrder = (source: Source, performance: Performance | null, options: object): PersonaOrder => ({
  ...{ kind: 'persona', source, performance, options },
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
  const { source, performance, options } = order;
  const inputs: JobRequest['inputs'] = {};
  if (source.by === 'persona') inputs.persona = source.id;
  else {
    const ids: string[] = [];
    const count = source.photos.length;
    for (const [index, { file }] of source.photos.entries()) ids.push(await upload(file, 'photos', { number: index + 1, count }));
    inputs.photos = ids;
  }
  if (performance) inputs.driver = performance.by === 'name' ? performance.name : await upload(performance.file, 'driver');
  const names = namesOf(order);
  return { inputs, options, metadata: { picture: names.picture, ...(performance && { performance: names.performance }) } };
}

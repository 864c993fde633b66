/** Live portraits: begun, and the messages that their WebSockets carry. */

import { answer, type Schemas, service } from './client';

export type Live = Schemas['LiveOut'];

/** What is in the way of the calibration. */
export type Obstacle = 'turned' | 'eyes_shut' | 'mouth_open' | 'moving';

/** What the service says beside frames. */
export type LiveEvent =
  | { event: 'preparing' | 'ready' | 'no_face' }
  | { event: 'calibrating'; fraction: number; obstacle: Obstacle | null }
  | { event: 'ended'; code: string; detail: string };

export const beginLive = (image: string): Promise<Live> => answer(service.POST('/v1/live', { body: { image, options: {} } }));

/** Where a live portrait is seen without its camera. */
export const viewPath = (id: string, token: string): string =>
  `/v1/live/${encodeURIComponent(id)}/view?token=${encodeURIComponent(token)}`;

/** Upload a picture at once; its id. */
export async function uploadPicture(file: File): Promise<string> {
  const body = new FormData();
  body.append('file', file);
  const sent = service.POST('/v1/files', { body: { file: '' }, bodySerializer: () => body });
  return (await answer(sent)).id;
}

/** Addresses that are told of jobs, and what they were told. */

import { aborted, answer, type Schemas, service } from './client';

export type Webhook = Schemas['WebhookOut'];
export type NewWebhook = Schemas['NewWebhookOut'];
export type WebhookEvent = Schemas['EventType'];
export type WebhookSecret = Schemas['SecretOut'];
export type Delivery = Schemas['DeliveryOut'];
export type DeliveryDetail = Schemas['DeliveryDetail'];

const webhook = (id: string) => ({ path: { webhook_id: id } });
const delivery = (id: string) => ({ path: { delivery_id: id } });

export const listWebhooks = async (signal?: AbortSignal): Promise<Webhook[]> =>
  (await answer(service.GET('/v1/webhooks', aborted(signal)))).items;

/** Have an address told of jobs. The answer holds the secret that signs the messages. */
export const createWebhook = (url: string, events: WebhookEvent[]): Promise<NewWebhook> =>
  answer(service.POST('/v1/webhooks', { body: { url, events } }));

export const enableWebhook = (id: string, enabled: boolean): Promise<Webhook> =>
  answer(service.PATCH('/v1/webhooks/{webhook_id}', { params: webhook(id), body: { enabled } }));

export async function deleteWebhook(id: string): Promise<void> {
  await answer(service.DELETE('/v1/webhooks/{webhook_id}', { params: webhook(id) }));
}

export const getWebhookSecret = (id: string): Promise<WebhookSecret> =>
  answer(service.GET('/v1/webhooks/{webhook_id}/secret', { params: webhook(id) }));

/** A new secret; the old one signs beside it for a day. */
export const rotateWebhookSecret = (id: string): Promise<WebhookSecret> =>
  answer(service.POST('/v1/webhooks/{webhook_id}/secret/rotate', { params: webhook(id) }));

export const testWebhook = (id: string): Promise<Delivery> =>
  answer(service.POST('/v1/webhooks/{webhook_id}/test', { params: webhook(id) }));

/** What was told, newest first: the latest, or what comes after a cursor. */
export const listDeliveries = (cursor: string | null, signal?: AbortSignal): Promise<Schemas['DeliveryPage']> =>
  answer(
    service.GET('/v1/webhooks/deliveries', {
      params: { query: { limit: 20, ...(cursor && { cursor }) } },
      ...aborted(signal),
    }),
  );

export const getDelivery = (id: string, signal?: AbortSignal): Promise<DeliveryDetail> =>
  answer(service.GET('/v1/webhooks/deliveries/{delivery_id}', { params: delivery(id), ...aborted(signal) }));

export const replayDelivery = (id: string): Promise<Delivery> =>
  answer(service.POST('/v1/webhooks/deliveries/{delivery_id}/replay', { params: delivery(id) }));

/** The order that is under way, kept by the browser: should the page be closed or loaded anew, it can go on. */

import type { Order } from '../kind/kind';

const DATABASE = 'galatea';
const STORE = 'orders';
const ONLY = 'pending';
/** What has arrived, beside the order: with each file that arrives, all files of the order would be written again. */
const SENT = 'sent';

export const keepPending = (order: Order): Promise<unknown> =>
  within('readwrite', (store) => {
    store.put(order.sent, SENT);
    return store.put(order, ONLY);
  });

/** As keepPending, where nothing but what has arrived is new. */
export const keepSent = ({ sent }: Order): Promise<unknown> => within('readwrite', (store) => store.put(sent, SENT));

export const forgetPending = (): Promise<unknown> => within('readwrite', (store) => store.clear());

/** The order that was not finished; null where there is none. */
export async function readPending(): Promise<Order | null> {
  const order = (await within('readonly', (store) => store.get(ONLY))) as Order | null;
  const sent = order && ((await within('readonly', (store) => store.get(SENT))) as Order['sent'] | null);
  return order ? { ...order, sent: sent ?? order.sent } : null;
}

/** A browser may keep nothing (private windows, a full disk): then there is nothing to go on with, and no harm. */
function within(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest): Promise<unknown> {
  return new Promise((resolve) => {
    const nothing = (): void => resolve(null);
    try {
      const opening = indexedDB.open(DATABASE, 1);
      opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
      opening.onerror = nothing;
      opening.onsuccess = () => {
        const database = opening.result;
        const transaction = database.transaction(STORE, mode);
        const request = act(transaction.objectStore(STORE));
        transaction.oncomplete = () => {
          database.close();
          resolve(request.result);
        };
        transaction.onabort = nothing;
      };
    } catch {
      nothing();
    }
  });
}

/** The order that is under way, kept by the browser: should the page be closed or loaded anew, it can go on. */

import type { Order } from '../kind/kind';

const DATABASE = 'galatea';
const STORE = 'orders';
const ONLY = 'pending';

export const keepPending = (order: Order): Promise<unknown> => within('readwrite', (store) => store.put(order, ONLY));

export const forgetPending = (): Promise<unknown> => within('readwrite', (store) => store.delete(ONLY));

/** The order that was not finished; null where there is none. */
export const readPending = async (): Promise<Order | null> =>
  ((await within('readonly', (store) => store.get(ONLY))) as Order | null) ?? null;

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

/** Whether the service wants to know who comes: it answers 401 then, whatever is asked. */

const listeners = new Set<() => void>();

/** Calls back when the service asks for a key; returns what ends that. */
export function onLocked(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export function tellLocked(): void {
  for (const listener of listeners) listener();
}

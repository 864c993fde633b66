/** Keys that make a request safe to repeat. */

/** `crypto.randomUUID` exists on secure pages only; a service on a LAN is not one. */
export function randomKey(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, '0')).join('');
}

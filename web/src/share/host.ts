/** Whom an address reaches. */

/** Whether an address of this host leads whoever has it to their own machine. */
export const isLoopback = (host: string): boolean => /^(localhost|.*\.localhost|127(\.\d+){3}|\[::1\])$/.test(host);

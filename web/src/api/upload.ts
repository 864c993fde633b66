/** Sending a file in a way that a pause, a broken line or a reload of the page cannot undo (tus 1.0). */

import { Problem, problemFrom } from '.';

/** Where uploading can be halted and taken up again; one for all files of an order. */
export class PauseControl {
  private shut = false;
  private readonly listeners = new Set<(shut: boolean) => void>();

  get closed(): boolean {
    return this.shut;
  }

  set closed(shut: boolean) {
    this.shut = shut;
    for (const listener of this.listeners) listener(shut);
  }

  /** Calls back at each change; returns what ends that. */
  watch(listener: (shut: boolean) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
}

/** Why sending is aborted when nobody wants to go on with it later; for other reasons, what has arrived is kept. */
export const GIVEN_UP = 'given up';

/** After so many milliseconds each, a broken line is tried again; then the visitor is told. */
const RETRIES = [0, 1000, 3000, 5000];

/** Answers after which the same may be welcome: another request is at work on it, or it was too much within a minute. */
const LATER = [409, 423, 429];

const isWorthAnother = (status: number): boolean => navigator.onLine && (status < 400 || status >= 500 || LATER.includes(status));

/**
 * Send one file; resolves to its id. What was sent of it before, on this page or an earlier one, is not sent again.
 * `onProgress` is told how many of its bytes have been sent.
 */
export async function uploadFile(
  file: File,
  onProgress: (sent: number) => void,
  pauseControl: PauseControl,
  signal: AbortSignal,
): Promise<string> {
  const { Upload, DetailedError } = await import('tus-js-client');
  if (signal.aborted) throw new DOMException('canceled', 'AbortError');
  return new Promise((resolve, reject) => {
    const end = (finish: () => void) => (): void => {
      stopWatching();
      finish();
    };
    const upload = new Upload(file, {
      endpoint: '/v1/uploads',
      metadata: { filename: file.name, filetype: file.type },
      retryDelays: RETRIES,
      removeFingerprintOnSuccess: true,
      onShouldRetry: (error) => isWorthAnother(error.originalResponse?.getStatus() ?? 0),
      onProgress,
      onSuccess: () => end(() => resolve(upload.url?.split('/').at(-1) ?? ''))(),
      onError: (error) =>
        end(() => {
          const answer = error instanceof DetailedError ? error.originalResponse : null;
          reject(answer ? problemFrom(answer.getStatus(), answer.getBody()) : new Problem(0, 'unreachable', ''));
        })(),
    });
    const stopWatching = pauseControl.watch((shut) => (shut ? void upload.abort() : upload.start()));
    signal.addEventListener(
      'abort',
      end(() => {
        upload.abort(signal.reason === GIVEN_UP).catch(() => undefined); // what cannot be erased now, the service erases after a while
        reject(new DOMException('canceled', 'AbortError'));
      }),
      { once: true },
    );
    void upload.findPreviousUploads().then(([before]) => {
      if (signal.aborted) return;
      if (before) upload.resumeFromPreviousUpload(before);
      if (!pauseControl.closed) upload.start();
    });
  });
}

/** Sending a file. `fetch` cannot tell how much of a body has left, so this is an XMLHttpRequest. */

import { Problem, problemFrom } from './api';

/** Send one file; resolves to its id. `onProgress` is told how many of its bytes have been sent. */
export function uploadFile(file: File, onProgress: (sent: number) => void, signal: AbortSignal): Promise<string> {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    const body = new FormData();
    body.append('file', file, file.name);

    request.upload.onprogress = (event) => {
      // The body is the file and a few hundred bytes around it.
      onProgress(Math.min(file.size, Math.round((event.loaded / event.total) * file.size)));
    };
    request.onload = () => {
      if (request.status >= 200 && request.status < 300) {
        onProgress(file.size);
        resolve((JSON.parse(request.responseText) as { id: string }).id);
      } else {
        reject(problemFrom(request.status, request.responseText));
      }
    };
    request.onerror = () => reject(new Problem(0, 'unreachable', ''));
    request.onabort = () => reject(new DOMException('canceled', 'AbortError'));
    signal.addEventListener('abort', () => request.abort(), { once: true });

    request.open('POST', '/v1/files');
    request.send(body);
  });
}

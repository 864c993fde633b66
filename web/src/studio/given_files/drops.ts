/** Files that are dropped beside their place, or pasted, still find it. */

import { useLayoutEffect, useRef } from 'preact/hooks';

/** `onFile` says whether it took the file; `onNone` is called where none of them was taken. */
export function useDropsAnywhere(onFile: (file: File) => Promise<boolean>, onNone: () => void): void {
  useDataAnywhere(async ({ files }) => {
    const taken = await Promise.all([...files].map(onFile));
    if (taken.length > 0 && !taken.includes(true)) onNone();
  });
}

/** `onData` is given all that is dropped or pasted at once, as the browser has it: folders among it. */
export function useDataAnywhere(onData: (data: DataTransfer) => Promise<void>): void {
  const latest = useRef(onData);
  latest.current = onData;
  // Before the page is painted: whoever sees where files go may drop one, and the browser would leave the page to show it.
  useLayoutEffect(() => {
    const take = (data: DataTransfer | null): void => {
      if (data) void latest.current(data);
    };
    const allow = (event: DragEvent): void => event.preventDefault();
    const drop = (event: DragEvent): void => {
      if (event.defaultPrevented) return; // a dropzone took it
      event.preventDefault(); // otherwise the browser would leave the page to show the file
      take(event.dataTransfer);
    };
    const paste = (event: ClipboardEvent): void => take(event.clipboardData);
    addEventListener('dragover', allow);
    addEventListener('drop', drop);
    addEventListener('paste', paste);
    return () => {
      removeEventListener('dragover', allow);
      removeEventListener('drop', drop);
      removeEventListener('paste', paste);
    };
  }, []);
}

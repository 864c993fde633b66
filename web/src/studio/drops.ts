/** A file that is dropped beside its place, or pasted, still finds it. */

import { useLayoutEffect, useRef } from 'preact/hooks';

/** `onFile` says whether it took the file; `onNone` is called where none of them was taken. */
export function useDropsAnywhere(onFile: (file: File) => Promise<boolean>, onNone: () => void): void {
  const latest = useRef({ onFile, onNone });
  latest.current = { onFile, onNone };
  // Before the page is painted: whoever sees where files go may drop one, and the browser would leave the page to show it.
  useLayoutEffect(() => {
    const take = async (files: Iterable<File>): Promise<void> => {
      const taken = await Promise.all([...files].map((file) => latest.current.onFile(file)));
      if (taken.length > 0 && !taken.includes(true)) latest.current.onNone();
    };
    const allow = (event: DragEvent): void => event.preventDefault();
    const drop = (event: DragEvent): void => {
      if (event.defaultPrevented) return; // a dropzone took it
      event.preventDefault(); // otherwise the browser would leave the page to show the file
      void take(event.dataTransfer?.files ?? []);
    };
    const paste = (event: ClipboardEvent): void => void take(event.clipboardData?.files ?? []);
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

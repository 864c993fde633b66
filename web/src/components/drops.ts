/** A file that is dropped beside its place, or pasted, still finds it. */

import { useEffect } from 'preact/hooks';

/** `onFile` says whether it took the file; `onNone` is called where none of them was taken. */
export function useDropsAnywhere(onFile: (file: File) => Promise<boolean>, onNone: () => void): void {
  useEffect(() => {
    const take = async (files: Iterable<File>): Promise<void> => {
      const taken = await Promise.all([...files].map(onFile));
      if (taken.length > 0 && !taken.includes(true)) onNone();
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

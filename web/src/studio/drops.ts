/** A file that is dropped beside its place, or pasted, still finds it. */

import { useEffect } from 'preact/hooks';

export function useDropsAnywhere(onFile: (file: File) => Promise<void>): void {
  useEffect(() => {
    const take = (files: Iterable<File>): void => {
      for (const file of files) void onFile(file);
    };
    const allow = (event: DragEvent): void => event.preventDefault();
    const drop = (event: DragEvent): void => {
      if (event.defaultPrevented) return; // a dropzone took it
      event.preventDefault(); // otherwise the browser would leave the page to show the file
      take(event.dataTransfer?.files ?? []);
    };
    const paste = (event: ClipboardEvent): void => take(event.clipboardData?.files ?? []);
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

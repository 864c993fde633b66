/** Many files at once, out of folders too: each with where it lay, so that none is taken twice. */

export interface Collected {
  file: File;
  /** With the folders that it lay in: `holiday/beach/1.jpg`. */
  path: string;
}

/** Of files that were browsed for; those of a folder know where in it they lay. */
export const collected = (files: Iterable<File>): Collected[] =>
  [...files].map((file) => ({ file, path: file.webkitRelativePath || file.name }));

/** Of what was dropped or pasted: files, and all that is in folders. What cannot be read by now is left out. */
export async function collectedFrom(data: DataTransfer): Promise<Collected[]> {
  // what was dropped is gone at the first pause: entries and files are taken before
  const items = [...data.items].filter(({ kind }) => kind === 'file');
  const taken = items.map((item) => ({ entry: item.webkitGetAsEntry(), file: item.getAsFile() }));
  const found = taken.map(({ entry, file }) => (entry?.isDirectory ? within(entry as FileSystemDirectoryEntry) : collected(file ? [file] : [])));
  return (await Promise.all(found)).flat();
}

/** Whatever lies in a folder, and in folders in it, in the order of names. */
export async function within(folder: FileSystemDirectoryEntry): Promise<Collected[]> {
  const entries = (await listed(folder)).sort((one, other) => (one.name < other.name ? -1 : 1));
  const found: Collected[] = [];
  for (const entry of entries) {
    if (entry.isDirectory) found.push(...(await within(entry as FileSystemDirectoryEntry)));
    else if (entry.isFile) found.push(...(await read(entry as FileSystemFileEntry)));
  }
  return found;
}

const read = (entry: FileSystemFileEntry): Promise<Collected[]> =>
  new Promise((done) => {
    entry.file(
      (file) => done([{ file, path: entry.fullPath.replace(/^\//, '') }]),
      () => done([]),
    );
  });

/** A reader gives a hundred entries at a time, and none at the end. */
async function listed(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((done) => reader.readEntries(done, () => done([])));
    if (!some.length) return all;
    all.push(...some);
  }
}

/** By which a file is known again. */
export const identity = ({ file, path }: Collected): string => `${path} ${file.size} ${file.lastModified}`;

/** Those of before, and what is new among the others. */
export function joined(before: readonly Collected[], more: readonly Collected[]): Collected[] {
  const all = new Map([...before, ...more].map((one) => [identity(one), one]));
  return [...all.values()];
}

/** The folder that all of them lay in; null where there is no one such. */
export function commonFolder(all: readonly Collected[]): string | null {
  const folders = new Set(all.map(({ path }) => (path.includes('/') ? path.split('/')[0]! : null)));
  return folders.size === 1 ? [...folders][0]! : null;
}

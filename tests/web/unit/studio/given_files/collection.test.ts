import { collected, commonFolder, joined, within } from '@web/studio/given_files/collection';
import { photosAmong } from '@web/kinds/persona/collection/photo_files';
import { describe, expect, it } from 'vitest';

const file = (name: string, content = 'x'): File => new File([content], name, { lastModified: 1 });

/** A folder as browsers give it: its entries come by twos, and none at the end. */
function folder(path: string, entries: object[]): FileSystemDirectoryEntry {
  const name = path.split('/').at(-1);
  const createReader = () => {
    let read = 0;
    return { readEntries: (done: (some: object[]) => void) => done(entries.slice(read, (read += 2))) };
  };
  return { name, fullPath: path, isDirectory: true, isFile: false, createReader } as never;
}
const entry = (path: string): object => ({
  ...{ name: path.split('/').at(-1), fullPath: path, isDirectory: false, isFile: true },
  file: (done: (file: File) => void, fail: () => void) => (path.endsWith('gone.jpg') ? fail() : done(file(path.split('/').at(-1)!))),
});

describe('a folder that is dropped', () => {
  it('gives all that lies in it, however deep, and leaves out what cannot be read', async () => {
    const all = folder('/aunt', [
      ...['/aunt/3.jpg', '/aunt/1.jpg', '/aunt/gone.jpg'].map(entry),
      folder('/aunt/2', [entry('/aunt/2/a.jpg'), entry('/aunt/2/b.jpg'), entry('/aunt/2/c.jpg')]),
    ]);
    expect((await within(all)).map(({ path }) => path)).toEqual(
      ['aunt/1.jpg', 'aunt/2/a.jpg', 'aunt/2/b.jpg', 'aunt/2/c.jpg', 'aunt/3.jpg'],
    );
  });
});

describe('files that are given in several turns', () => {
  const at = (path: string, content?: string) => ({ file: file(path.split('/').at(-1)!, content), path });

  it('are taken once each, and two of one name from two folders are two', () => {
    const all = joined([at('a/1.jpg'), at('b/1.jpg')], [at('a/1.jpg'), at('a/1.jpg', 'another'), at('a/2.jpg')]);
    expect(all.map(({ path, file }) => [path, file.size])).toEqual([['a/1.jpg', 1], ['b/1.jpg', 1], ['a/1.jpg', 7], ['a/2.jpg', 1]]);
  });

  it('have a name where one folder held them all', () => {
    expect(commonFolder([at('Aunt/1.jpg'), at('Aunt/2/3.jpg')])).toBe('Aunt');
    expect(commonFolder([at('Aunt/1.jpg'), at('3.jpg')])).toBeNull();
    expect(commonFolder(collected([file('3.jpg')]))).toBeNull();
  });

  it('are photos and archives by what is in them; hidden ones are not spoken of', async () => {
    const photo = { file: new File([Uint8Array.from([255, 216, 255, 224])], '1.txt'), path: '1.txt' };
    const archive = at('album', 'PK\x03\x04');
    const given = await photosAmong([photo, archive, at('letter.jpg', 'Dear aunt'), at('.DS_Store'), at('__MACOSX/1.jpg')]);
    expect(given).toEqual({ photos: [photo, archive], others: 1 });
  });
});

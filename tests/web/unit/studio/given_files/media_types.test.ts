import { isMotion, isPicture, isVideo, mediaIn } from '@web/studio/given_files/media_types';
import { describe, expect, it } from 'vitest';

describe('what a file may be', () => {
  const bytes = (text: string): BlobPart => Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const file = (start: string, name = 'a'): File => new File([bytes(start)], name);

  it.each([
    ['a JPEG', '\xff\xd8\xff\xe0', 'picture'],
    ['a PNG', '\x89PNG\r\n\x1a\n', 'picture'],
    ['a WebP', 'RIFF\x10\0\0\0WEBPVP8 ', 'picture'],
    ['a HEIC', '\0\0\0\x18ftypheic', 'picture'],
    ['an AVIF', '\0\0\0\x18ftypavif', 'picture'],
    ['a GIF: it moves', 'GIF89a', 'video'],
    ['an MP4', '\0\0\0\x18ftypisom', 'video'],
    ['a MOV', '\0\0\0\x14ftypqt  ', 'video'],
    ['an old MOV', '\0\0\0\x08wide', 'video'],
    ['a WebM', '\x1a\x45\xdf\xa3', 'video'],
    ['an AVI', 'RIFF\x10\0\0\0AVI LIST', 'video'],
    ['a BVH', '\r\nHIERARCHY\nROOT Hips', 'motion'],
    ['a GLB', 'glTF\x02\0\0\0', 'motion'],
    ['a glTF', '\xef\xbb\xbf{ "asset": {', 'motion'],
    ['a ZIP', 'PK\x03\x04\x14\0', 'archive'],
    ['a compressed TAR', '\x1f\x8b\x08\0', 'archive'],
    ['a TAR', `${'photo.jpg'.padEnd(257, '\0')}ustar\0`, 'archive'],
    ['a text', 'This is a letter.', null],
    ['a sound', 'RIFF\x10\0\0\0WAVEfmt ', null],
    ['a sound in MP4', '\0\0\0\x18ftypM4A ', null],
    ['nothing', '', null],
  ])('knows %s by its first bytes', async (_what, start, media) => {
    const one = file(start, 'holiday.jpg');
    expect([await isPicture(one), await isVideo(one), await isMotion(one)]).toEqual(
      ['picture', 'video', 'motion'].map((kind) => kind === media),
    );
    expect(await mediaIn(one)).toBe(media);
  });
});

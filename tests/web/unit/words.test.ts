import { problemFrom } from '@web/api';
import { kinds } from '@web/kinds';
import { isMotion, isPicture, isVideo } from '@web/studio/media_types';
import { failureRemedy, failureTitle } from '@web/kind/failures';
import { chooseLanguage, plain } from '@web/language/strings';
import { describe, expect, it } from 'vitest';

describe('trouble in plain words', () => {
  it('shows the sentence of the service', () => {
    const problem = problemFrom(422, JSON.stringify({ code: 'no_face', detail: 'Choose another picture.' }));
    expect(failureTitle(kinds.all, problem.code)).toBe('No face was found');
    expect(failureRemedy(problem.code, problem.detail)).toBe('Choose another picture.');
  });

  it('has words of its own for answers that bring none', () => {
    const proxy = problemFrom(413, '<html>Request Entity Too Large</html>');
    expect(failureRemedy(proxy.code, proxy.detail)).toContain('larger');
    const unknown = problemFrom(500, '');
    expect(failureTitle(kinds.all, unknown.code)).toBe('This did not work');
    expect(failureRemedy(unknown.code, unknown.detail)).toContain('try again');
  });

  it('reads a stage as words', () => {
    expect(plain('expression_ratio_images')).toBe('Expression ratio images');
  });
});

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
    ['a text', 'This is a letter.', null],
    ['a sound', 'RIFF\x10\0\0\0WAVEfmt ', null],
    ['a sound in MP4', '\0\0\0\x18ftypM4A ', null],
    ['nothing', '', null],
  ])('knows %s by its first bytes', async (_what, start, media) => {
    const one = file(start, 'holiday.jpg');
    expect([await isPicture(one), await isVideo(one), await isMotion(one)]).toEqual(
      ['picture', 'video', 'motion'].map((kind) => kind === media),
    );
  });
});

describe('the language of the page', () => {
  const offered = ['en', 'de', 'pt-BR'];

  it('is the first wish that is offered, for another region too', () => {
    expect(chooseLanguage(['fr', 'de-AT', 'en'], offered)).toBe('de');
    expect(chooseLanguage(['pt-br'], offered)).toBe('pt-BR');
    expect(chooseLanguage(['en-GB', 'de'], offered)).toBe('en');
  });

  it('is English where no wish is offered', () => {
    expect(chooseLanguage(['pt-PT', 'ja'], offered)).toBe('en');
    expect(chooseLanguage([], offered)).toBe('en');
  });
});

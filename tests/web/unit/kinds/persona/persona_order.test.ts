import { kinds } from '@web/kinds';
import { colourOf, hexOf } from '@web/kinds/persona/colour';
import { namesOf, personaOrder, request } from '@web/kinds/persona/order';
import { carriedOver } from '@web/kinds/persona/types';
import { curlOf } from '@web/share/requests';
import { pictureUrl } from '@web/works/names';
import { describe, expect, it } from 'vitest';
import { aJob } from '../../job';

const photo = (path: string) => ({ file: new File(['x'], path.split('/').at(-1)!), path });
const byPhotos = (...paths: string[]) => ({ by: 'photos' as const, photos: paths.map(photo) });

describe('an order of a persona', () => {
  it('sends photo by photo, and says which of how many each is', async () => {
    const order = personaOrder({
      source: byPhotos('1.jpg', '2.jpg'),
      performance: { by: 'file', file: new File(['x'], 'a_talk.mp4') },
      performer: [photo('me.jpg')],
      backdrop: new File(['x'], 'beach.png'),
      options: { sound: true },
    });
    const sent: string[] = [];
    const asked = await request(order, async (file, part, place) => `${sent.push(`${part} ${place?.number}/${place?.count} ${file.name}`)}`);
    expect(sent).toEqual(['photos 1/2 1.jpg', 'photos 2/2 2.jpg', 'driver undefined/undefined a_talk.mp4', 'driver_photos 1/1 me.jpg',
      'background_picture undefined/undefined beach.png']);
    expect(asked).toEqual({
      inputs: { photos: ['1', '2'], driver: '3', driver_photos: ['4'], background_picture: '5' },
      options: { sound: true },
      metadata: { picture: '2 photos', performance: 'A talk' },
    });
  });

  it('names an earlier one by its job, and sends nothing then', async () => {
    const order = personaOrder({
      source: { by: 'persona', id: 'a-job', name: 'Aunt' },
      performance: { by: 'name', name: 'happy' },
      performer: [],
      options: {},
    });
    const asked = await request(order, () => Promise.reject(new Error('sent')));
    expect(asked).toEqual({ inputs: { persona: 'a-job', driver: 'happy' }, options: {}, metadata: { picture: 'Aunt', performance: 'Happy' } });
  });

  it('is called like the folder, or the archive, or by how many photos there are', () => {
    const name = (...paths: string[]) => namesOf(personaOrder({ source: byPhotos(...paths), performance: null, performer: [], options: {} })).picture;
    expect([name('aunt_mary/1.jpg', 'aunt_mary/2.jpg'), name('album.zip'), name('1.jpg', '2.jpg', '3.jpg')]).toEqual(
      ['Aunt mary', 'Album', '3 photos'],
    );
  });

  it('takes along to another performance what is of the picture', () => {
    expect(carriedOver({ size: [64, 64], trim: [0, 1], keep: [3], texture_width: 200, composite: 'side_by_side' })).toEqual({
      size: [64, 64],
      composite: 'side_by_side',
    });
  });

  it('chooses colours as browsers write them', () => {
    expect(hexOf([58, 60, 4])).toBe('#3a3c04');
    expect(colourOf('#3a3c04')).toEqual([58, 60, 4]);
  });
});

describe('a job of many photos', () => {
  const id = '0198c1d2-7b1a-7c3e-9c6d-00000000000';
  const job = aJob({ kind: 'persona', inputs: { photos: [`${id}1`, `${id}2`], driver: 'happy' }, metadata: { picture: 'Aunt' } });

  it('shows the first of them', () => {
    expect(pictureUrl(job, kinds.of('persona'))).toBe(`/v1/files/${id}1/content`);
  });

  it('is asked for again by an archive that stands for all', () => {
    expect(curlOf(job, kinds.of('persona'), 'http://x', false)).toContain('-F photos=@aunt.zip');
  });
});

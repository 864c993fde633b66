import { failureTitle } from '@web/kind/failures';
import { kinds } from '@web/kinds';
import { shownIn } from '@web/kinds/generic/artifacts';
import { genericKind } from '@web/kinds/generic';
import { genericOrder } from '@web/kinds/generic/order';
import { fieldsOf } from '@web/kinds/generic/schema';
import type { Kind } from '@web/kind/kind';
import { stageName } from '@web/kind/stage_names';
import { parseRoute } from '@web/route';
import { describe, expect, it } from 'vitest';

describe('the list of kinds', () => {
  it('holds each once, under an address that leads to it', () => {
    expect(kinds.all.map(({ name }) => name)).toEqual(['portrait', 'character', 'avatar', 'persona']);
    for (const { name, link } of [...kinds.all, kinds.of('a toy')]) expect(parseRoute(kinds.all, link)).toEqual({ page: 'studio', kind: name });
  });

  it('offers what the service has: its own kinds in their order, then others, without those that look into files', () => {
    const offered = kinds.offered(['tiny', 'moments', 'character', 'portrait', 'motion']);
    expect(offered.map(({ label, link }) => [label, link])).toEqual([
      ['Portrait', '#/'],
      ['Character', '#/character'],
      ['Tiny', '#/make/tiny'],
    ]);
    expect(kinds.offered(['character'])).toHaveLength(1);
  });

  it('has each say which kinds look into files for it, and none of these is a work', () => {
    expect(kinds.all.map(({ inspections }) => inspections)).toEqual([['moments'], ['motion'], ['motion'], []]);
    expect(kinds.offered(kinds.all.flatMap(({ inspections }) => inspections))).toEqual([]);
  });

  it('has each name what is sent for an order', () => {
    expect(kinds.of('portrait').files).toMatchObject({ portrait: 'the portrait', video: 'the video' });
    expect(kinds.of('character').files).toMatchObject({ photo: 'the picture', labels: 'the body parts' });
  });

  it('is told apart by the same loaders each time, so that nothing is drawn anew', () => {
    expect(kinds.of('tiny').loadStudio).toBe(kinds.of('tiny').loadStudio);
  });

  it('names stages and failures by kind, and by another where only that one knows them', () => {
    expect(stageName(kinds, 'portrait', 'rig_target')).toBe('Rigging the portrait');
    expect(stageName(kinds, 'character', 'fetch')).toBe('Downloading the inputs');
    expect(stageName(kinds, 'moments', 'track_driver')).toBe('Tracking the performance');
    expect(stageName(kinds, 'tiny', 'weigh_all')).toBe('Weigh all');
    expect([failureTitle(kinds.all, 'no_face'), failureTitle(kinds.all, 'crowd')]).toEqual(['No face was found', 'The picture shows a crowd']);
  });

  it('takes a folder that says only what it has otherwise', () => {
    const toy: Kind = { ...genericKind('toy'), label: 'A toy', stages: { weigh_all: 'Weighing' } };
    expect(toy).toMatchObject({ label: 'A toy', link: '#/make/toy', stages: { weigh_all: 'Weighing' } });
    expect(toy.loadStudio).toBe(genericKind('other').loadStudio);
  });
});

describe('a form from a schema', () => {
  const schema = {
    type: 'object',
    $defs: { Mood: { type: 'string', enum: ['calm', 'wild'] }, Box: { type: 'array', items: { type: 'number' } } },
    properties: {
      loop: { type: 'boolean', default: false, description: 'Whether the end\nleads back.' },
      strength: { type: 'number', minimum: 0, maximum: 1.5, default: 1 },
      frames: { anyOf: [{ type: 'integer', exclusiveMinimum: 0 }, { type: 'null' }], default: null },
      mood: { $ref: '#/$defs/Mood' },
      sound: { anyOf: [{ type: 'boolean' }, { type: 'null' }], default: null },
      parts: { type: 'array', items: { $ref: '#/$defs/Mood' }, default: ['calm'] },
      box: { anyOf: [{ $ref: '#/$defs/Box' }, { type: 'null' }] },
      author: { type: 'string', default: 'nobody' },
      either: { anyOf: [{ type: 'integer' }, { const: 'all' }] },
    },
  };
  const fields = Object.fromEntries(fieldsOf(schema).map((field) => [field.name, field]));

  it('has a field for every property, of the kind that can hold it', () => {
    expect(Object.values(fields).map(({ type }) => type)).toEqual(
      ['switch', 'number', 'number', 'choice', 'choice', 'several', 'json', 'text', 'json'],
    );
  });

  it('says what holds where nothing is said, and between what', () => {
    expect(fields.loop).toMatchObject({ label: 'Loop', hint: 'Whether the end leads back.', usual: false });
    expect(fields.strength).toMatchObject({ whole: false, min: 0, max: 1.5, usual: 1 });
    expect(fields.frames).toMatchObject({ whole: true, min: 0, max: null, usual: null });
    expect(fields.mood).toMatchObject({ choices: ['calm', 'wild'] });
    expect(fields.sound).toMatchObject({ choices: [true, false] });
    expect(fields.parts).toMatchObject({ choices: ['calm', 'wild'], usual: ['calm'] });
  });
});

describe('an order of any kind', () => {
  const photo = new File(['x'], 'aunt_mary.jpg');
  const clip = new File(['x'], 'clip.mp4');

  it('sends each file once, names none, and keeps what was typed', async () => {
    const order = genericOrder('toy', { image: [photo], driver: 'happy', more: [clip, photo] }, ['more'], { level: 2 });
    const sent: string[] = [];
    const request = await kinds.of('toy').request(order, async (file, part) => `${sent.push(`${part}: ${file.name}`)}`);
    expect(sent).toEqual(['image: aunt_mary.jpg', 'more: clip.mp4', 'more 2: aunt_mary.jpg']);
    expect(request).toEqual({
      inputs: { image: '1', driver: 'happy', more: ['2', '3'] },
      options: { level: 2 },
      metadata: { picture: 'Aunt mary', performance: 'Happy' },
    });
  });
});

describe('what a job of any kind shows', () => {
  const artifact = (content_type: string) => ({ url: '/x', size: 1, sha256: '', content_type });
  const left = {
    'poster.jpg': artifact('image/jpeg'),
    'preview.jpg': artifact('image/jpeg'),
    'report.json': artifact('application/json'),
    'mask.png': artifact('image/png'),
    'animation.mp4': artifact('video/mp4'),
    'body.glb': artifact('model/gltf-binary'),
  };

  it('is what can be seen, the animation first, without what stands in for it', () => {
    expect(shownIn(left)).toEqual(['animation.mp4', 'mask.png', 'body.glb']);
  });

  it('is the preview where there is nothing else', () => {
    const { 'poster.jpg': poster, 'preview.jpg': preview, 'report.json': report } = left;
    expect(shownIn({ 'poster.jpg': poster, 'preview.jpg': preview, 'report.json': report })).toEqual(['preview.jpg']);
  });

  it('is opened by a link', () => {
    const { opened } = kinds.of('toy').shared;
    expect(Object.keys(left).filter((name) => opened.test(name))).toEqual(
      ['poster.jpg', 'preview.jpg', 'mask.png', 'animation.mp4', 'body.glb'],
    );
  });
});

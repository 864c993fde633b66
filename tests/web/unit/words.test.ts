import { problemFrom } from '@web/api';
import { isMotion, isPicture, isVideo } from '@web/media';
import { chooseLanguage, failureRemedy, failureTitle, plain } from '@web/strings';
import { describe, expect, it } from 'vitest';

describe('trouble in plain words', () => {
  it('shows the sentence of the service', () => {
    const problem = problemFrom(422, JSON.stringify({ code: 'no_face', detail: 'Choose another picture.' }));
    expect(failureTitle(problem.code)).toBe('No face was found');
    expect(failureRemedy(problem.code, problem.detail)).toBe('Choose another picture.');
  });

  it('has words of its own for answers that bring none', () => {
    const proxy = problemFrom(413, '<html>Request Entity Too Large</html>');
    expect(failureRemedy(proxy.code, proxy.detail)).toContain('larger');
    const unknown = problemFrom(500, '');
    expect(failureTitle(unknown.code)).toBe('This did not work');
    expect(failureRemedy(unknown.code, unknown.detail)).toContain('try again');
  });

  it('reads a stage as words', () => {
    expect(plain('expression_ratio_images')).toBe('Expression ratio images');
  });
});

describe('what a file may be', () => {
  const file = (name: string, type: string): File => new File(['x'], name, { type });

  it('knows a picture from a video by name or type', () => {
    expect(isPicture(file('a.jpg', ''))).toBe(true);
    expect(isPicture(file('photo', 'image/heic'))).toBe(true);
    expect(isVideo(file('A.MOV', ''))).toBe(true);
    expect(isPicture(file('a.mp4', 'video/mp4'))).toBe(false);
    expect(isVideo(file('notes.txt', 'text/plain'))).toBe(false);
  });

  it('knows a motion by its name: browsers have no type for most', () => {
    expect([isMotion(file('Jump.BVH', '')), isMotion(file('walk.glb', 'model/gltf-binary'))]).toEqual([true, true]);
    expect([isMotion(file('walk.gltf', '')), isMotion(file('walk', 'model/gltf+json'))]).toEqual([true, true]);
    expect([isMotion(file('walk.fbx', '')), isPicture(file('walk.glb', 'model/gltf-binary'))]).toEqual([false, false]);
  });

  it('takes a GIF for a performance: it moves', () => {
    const gif = file('a.gif', 'image/gif');
    expect([isPicture(gif), isVideo(gif)]).toEqual([false, true]);
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

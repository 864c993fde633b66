import { kinds } from '@web/kinds';
import { carriedOver } from '@web/kinds/portrait/other_moods';
import { isLoopback } from '@web/share/host';
import { curlOf, htmlOf, pythonOf } from '@web/share/requests';
import { execFileSync } from 'node:child_process';
import { describe, expect, it } from 'vitest';
import { aJob } from '../job';

const odd = aJob({
  inputs: { image: '0198c1d2-7b1a-7c3e-9c6d-000000000001', driver: "me's/$(happy)" },
  options: { strength: 0.5, loop: true, crop: null, follow: ['eyes'] } as never,
  metadata: { portrait: "Grace'; rm -rf ~ #" },
});

describe('the request behind a job', () => {
  it('is one that a shell hands on word by word, whatever the names hold', () => {
    const script = `${curlOf(odd, kinds.of(odd.kind), 'http://127.0.0.1:8000', false).replace('curl', "printf '%s\\n'")}`;
    const words = execFileSync('sh', ['-c', script]).toString().trim().split('\n');
    expect(words).toEqual([
      'http://127.0.0.1:8000/v1/jobs',
      ...['-H', 'Prefer: wait=60', '-F', 'kind=portrait', '-F', 'image=@grace-rm-rf.jpg'],
      ...['-F', "driver=me's/$(happy)", '-F', `options=${JSON.stringify(odd.options)}`],
    ]);
  });

  it('is Python that can be read', () => {
    const code = pythonOf(odd, kinds.of(odd.kind), 'https://faces.example', true);
    execFileSync('python3', ['-c', 'import ast, sys; ast.parse(sys.argv[1])', code]);
    expect(code).toContain('"loop": True, "crop": None, "follow": ["eyes"]');
    expect(code).toContain('{"image": Path("grace-rm-rf.jpg"), "driver": "me\'s/$(happy)"}');
    expect(code).toContain('key=os.environ["GALATEA_KEY"]');
  });

  it('shows a video as one, and nothing where there is none', () => {
    const file = { url: '/a', size: 1, sha256: '', content_type: 'video/mp4' } as never;
    expect(htmlOf(aJob({ artifacts: { 'animation.mp4': file } }))).toContain('<video src="animation.mp4" autoplay loop muted');
    expect(htmlOf(aJob())).toBeNull();
  });
});

it('takes along to another mood what is of the picture, and nothing of the performance', () => {
  expect(carriedOver({ strength: 0.5, trim: [0, 1], neutral_frame: 3, sound: true, crop: 'bust' })).toEqual({ strength: 0.5, crop: 'bust' });
});

it('knows which addresses lead to the visitor’s own machine', () => {
  expect(['localhost', '127.0.0.1', '127.8.0.1', '[::1]', 'a.localhost'].map(isLoopback)).toEqual(Array(5).fill(true));
  expect(['faces.example', '192.168.0.5', '10.0.0.1', 'localhost.example'].map(isLoopback)).toEqual(Array(4).fill(false));
});

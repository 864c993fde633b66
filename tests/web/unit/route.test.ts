import { kinds } from '@web/kinds';
import { historyLink, jobLink, parseRoute } from '@web/route';
import { describe, expect, it } from 'vitest';

describe('addresses', () => {
  it('finds the job that a link was made for', () => {
    for (const id of ['0198c1d2-7b1a-7c3e-9c6d-0a1b2c3d4e5f', 'a b/c']) {
      expect(parseRoute(kinds.all, jobLink(id))).toEqual({ page: 'job', id });
    }
  });

  it('finds the other pages', () => {
    expect(parseRoute(kinds.all, historyLink(null))).toEqual({ page: 'history', status: null, words: '' });
    expect(parseRoute(kinds.all, historyLink('failed'))).toEqual({ page: 'history', status: 'failed', words: '' });
    expect(parseRoute(kinds.all, '#/history/nonsense')).toEqual({ page: 'history', status: null, words: '' });
    expect(parseRoute(kinds.all, '#/shared/abc-_1')).toEqual({ page: 'shared', token: 'abc-_1' });
    expect(parseRoute(kinds.all, '#/keys')).toEqual({ page: 'keys' });
    expect(parseRoute(kinds.all, '#/character')).toEqual({ page: 'studio', kind: 'character' });
    expect(parseRoute(kinds.all, '#/make/a%20toy')).toEqual({ page: 'studio', kind: 'a toy' });
  });

  it('keeps the words of a search, whatever letters they have', () => {
    for (const words of ['mary', 'Möwe & 100% #1/2?', 'a+b']) {
      expect(parseRoute(kinds.all, historyLink('failed', words))).toEqual({ page: 'history', status: 'failed', words });
      expect(parseRoute(kinds.all, historyLink(null, words))).toEqual({ page: 'history', status: null, words });
    }
    expect(parseRoute(kinds.all, `#/history?q=${'x'.repeat(300)}`)).toMatchObject({ words: 'x'.repeat(200) });
  });

  it('finds the start page', () => {
    for (const hash of ['', '#', '#/', '#content']) expect(parseRoute(kinds.all, hash)).toEqual({ page: 'studio', kind: 'portrait' });
  });

  it('knows what means nothing, damaged links among them', () => {
    for (const hash of ['#/jobs/', '#/jobs/1/2', '#/jobs/%E0%A4%A', '#/shared/%', '#/keys/1', '#/nonsense', '#/Jobs/1']) {
      expect(parseRoute(kinds.all, hash), hash).toEqual({ page: 'lost' });
    }
    expect(parseRoute(kinds.all, '', '/galery')).toEqual({ page: 'lost' });
  });
});

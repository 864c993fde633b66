import { problemFrom } from '@web/api';
import { failureRemedy, failureTitle } from '@web/kind/failures';
import { kinds } from '@web/kinds';
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
});

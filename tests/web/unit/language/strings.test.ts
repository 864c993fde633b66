import { chooseLanguage, plain } from '@web/language/strings';
import { describe, expect, it } from 'vitest';

it('reads a name of the engine as words', () => {
  expect(plain('expression_ratio_images')).toBe('Expression ratio images');
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

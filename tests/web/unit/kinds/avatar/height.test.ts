import { heightIn } from '@web/kinds/avatar/height';
import { describe, expect, it } from 'vitest';

describe('a height', () => {
  it('is understood in centimetres and metres, with a point or a comma', () => {
    for (const text of ['175', '1.75', '1,75', '175cm', ' 1.75 m ', '175.0 CM']) expect(heightIn(text)).toBe(1.75);
  });

  it('is nothing where nothing is written', () => {
    expect(heightIn('  ')).toBe(null);
  });

  it('is refused where nobody is so tall, or it is no number', () => {
    for (const text of ['17', '2.41', '0.7', '300', '1.75 ft', 'tall', '1.75 cm', '-1.7']) expect(heightIn(text)).toBeNaN();
  });
});

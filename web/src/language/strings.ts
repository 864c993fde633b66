/** The words of the page, in the first of the visitor's languages that there is a file for; English where there is none. */

import english, { type Strings } from './words/en';

const files = import.meta.glob<{ default: Strings }>(['./words/*.ts', '!./words/en.ts']);
const tagOf = (path: string): string => path.replace(/^.*\/|\.ts$/g, '');

/** The first wish that is offered, as it is or for another region; tags as in BCP 47. */
export function chooseLanguage(wishes: readonly string[], offered: readonly string[]): string {
  for (const wish of wishes) {
    for (let tag = wish; tag; tag = tag.slice(0, Math.max(0, tag.lastIndexOf('-')))) {
      const found = offered.find((offer) => offer.toLowerCase() === tag.toLowerCase());
      if (found) return found;
    }
  }
  return 'en';
}

const wishes = globalThis.navigator?.languages ?? [];

export const language = chooseLanguage(wishes, ['en', ...Object.keys(files).map(tagOf)]);

/** The language with the visitor's region, for numbers and dates: `en-GB` where the words are those of `en`. */
export const locale = wishes.find((wish) => wish.toLowerCase().startsWith(language.toLowerCase())) ?? language;

/** These words in the page's language, where there is a file of them for it; files are named by their tags. */
export async function inLanguage<Words>(english: Words, files: Record<string, () => Promise<{ default: Words }>>): Promise<Words> {
  const file = Object.entries(files).find(([path]) => tagOf(path) === language);
  return (await file?.[1]())?.default ?? english;
}

export const strings: Strings = await inLanguage(english, files);

/** A name from the engine or the library in plain words: `expression_ratios` becomes `Expression ratios`. */
export function plain(name: string): string {
  const words = name.replace(/[_-]+/g, ' ').replace('/', ': ').trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

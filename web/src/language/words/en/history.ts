/** English: what was made: found again, called something, its versions; and what is kept under a name. */

export const history = {
  history: {
    title: 'History',
    search: 'Search',
    searchHint: 'Title, file or performance',
    clear: 'Clear search',
    filter: 'Show',
    all: 'All',
    empty: 'Nothing here yet',
    emptyHint: 'What you make will appear here.',
    begin: 'Make a portrait',
    none: 'Nothing with this status',
    nothingFound: (query: string) => `Nothing found for “${query}”`,
    nothingFoundHint: 'A search looks at titles and at the names of files, performances and motions. Each word has to occur.',
    showAll: 'Show all',
    found: (number: number, more: boolean) => `${more ? 'More than ' : ''}${number} found`,
    more: 'Show more',
    titleOf: (name: string) => `Title of “${name}”`,
    others: (number: number) => (number === 1 ? '1 other version' : `${number} other versions`),
    of: (name: string) => `of “${name}”`,
    version: (number: number) => `Version ${number}`,
    above: (number: number) => `Shown: version ${number}`,
    first: 'The first version',
    same: 'Nothing changed',
    changed: (what: string) => `Changed: ${what}`,
    now: (what: string, value: string) => `${what} (${value})`,
  },

  rename: { rename: 'Rename', save: 'Save' },

  /** Saved videos and motions. */
  kept: {
    manage: 'Rename or delete',
    nameOf: (name: string) => `New name of “${name}”`,
    removeQuestion: (name: string) => `Delete “${name}”? Results made with it stay.`,
    gone: (name: string) => `“${name}” was deleted.`,
  },
};

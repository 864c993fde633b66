/** Every word of the page, in English, but for those in the folders of the kinds and of the viewer. Another language is another file beside this one, named by its tag. */

import { failures } from './en/failures';
import { generic } from './en/generic';
import { history } from './en/history';
import { integrators } from './en/integrators';
import { job } from './en/job';
import { studio } from './en/studio';

const english = {
  name: 'Galatea',
  home: 'Galatea, start page',
  skip: 'Skip to the content',
  justNow: 'just now',
  make: { label: 'What to make' },

  recent: {
    title: 'Recent',
    empty: 'What you make will appear here.',
    all: 'Show all',
  },

  lost: {
    title: 'Page not found',
    detail: 'The address is incomplete, or the page no longer exists.',
    home: 'Go to the start page',
  },

  footer: {
    label: 'About Galatea',
    help: 'Help',
    api: 'API reference',
    openapi: 'OpenAPI',
    use: 'Responsible use',
    licences: 'Licences',
  },

  navigation: { label: 'Pages', history: 'History', keys: 'Keys', webhooks: 'Webhooks' },

  retry: 'Try again',
  close: 'Close',
  cancel: 'Cancel',
  copy: 'Copy',
  copied: 'Copied',
  reveal: 'Show',

  ...studio,
  ...generic,
  ...job,
  ...history,
  ...integrators,
  ...failures,
};

/** What every language has to say. */
export type Strings = typeof english;

export default english;

/** The address of the page that shows a live portrait and nothing else. */

import type { Live } from '../api';

export const livePage = ({ id, view }: Live): string => {
  const token = new URLSearchParams(view.replace(/^.*\?/, '')).get('token') ?? '';
  return `#/live/${encodeURIComponent(id)}/${encodeURIComponent(token)}`;
};

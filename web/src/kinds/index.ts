/** The kinds of jobs that have a folder here. Another one is a folder more and its name in this list. */

import { character } from './character';
import { genericKind } from './generic';
import type { Kind } from '../kind';
import { portrait } from './portrait';

/** In the order in which they are offered; the first one's studio is the start page. */
export const kinds: readonly [Kind, ...Kind[]] = [portrait, character];

/** Kinds whose jobs look into a file on behalf of the page: what they find is shown with that file, not as a work. */
export const inspections: readonly string[] = ['moments', 'motion'];

/** Every other kind that the service has is drawn from the service's own description. */
export const kindOf = (name: string): Kind => kinds.find((kind) => kind.name === name) ?? genericKind(name);

/** What can be made: the kinds of this list that the service has, and those that it has besides. */
export const offeredKinds = (names: readonly string[]): Kind[] => {
  const makers = names.filter((name) => !inspections.includes(name));
  const known = kinds.filter(({ name }) => makers.includes(name));
  return [...known, ...makers.filter((name) => !known.some((kind) => kind.name === name)).map(kindOf)];
};

/** The kinds of jobs that have a folder here. Another one is a folder more and its name in this list. */

import type { Kind } from '../kind/kind';
import type { Kinds } from '../kind/kinds';
import { avatar } from './avatar';
import { character } from './character';
import { genericKind } from './generic';
import { persona } from './persona';
import { portrait } from './portrait';

const all: Kinds['all'] = [portrait, character, avatar, persona];

const inspections: readonly string[] = all.flatMap((kind) => kind.inspections);

const of = (name: string): Kind => all.find((kind) => kind.name === name) ?? genericKind(name);

export const kinds: Kinds = {
  all,
  of,
  offered(names) {
    const makers = names.filter((name) => !inspections.includes(name));
    const known = all.filter(({ name }) => makers.includes(name));
    return [...known, ...makers.filter((name) => !known.some((kind) => kind.name === name)).map(of)];
  },
};

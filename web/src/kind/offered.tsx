/** Which kinds there are to make: those with a folder here at once, others as soon as the service has named them. */

import { type ComponentChildren, createContext } from 'preact';
import { useContext } from 'preact/hooks';
import { type KindDescription, listKinds } from '../api';
import { useLoaded } from '../api/loading';
import type { Kind } from './kind';
import { useKinds } from './kinds';

const Described = createContext<readonly KindDescription[] | null>(null);

interface Props {
  /** Whoever has but a link is told of nothing else. */
  guest: boolean;
  children: ComponentChildren;
}

export function OfferedKindsProvider({ guest, children }: Props) {
  const described = useLoaded(async (signal) => (guest ? null : listKinds(signal)), `kinds ${guest}`);
  return <Described.Provider value={described.value}>{children}</Described.Provider>;
}

/** What the service says of its kinds; null until it has. */
export const useDescriptions = (): readonly KindDescription[] | null => useContext(Described);

export const useOffered = (): readonly Kind[] => {
  const kinds = useKinds();
  const described = useDescriptions();
  return described ? kinds.offered(described.map(({ name }) => name)) : kinds.all;
};

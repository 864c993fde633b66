/** The kinds of jobs that the application knows. It alone has their list; everything below is given them here. */

import { createContext } from 'preact';
import { useContext } from 'preact/hooks';
import type { Kind } from './kind';

export interface Kinds {
  /** Those with a folder here, in the order in which they are offered; the first one's studio is the start page. */
  readonly all: readonly [Kind, ...Kind[]];
  /** The kind of this name: what has no folder is drawn from the service's own description. */
  of(name: string): Kind;
  /** What can be made where the service has kinds of these names. */
  offered(names: readonly string[]): readonly Kind[];
}

const Known = createContext<Kinds | null>(null);

export const KindsProvider = Known.Provider;

export function useKinds(): Kinds {
  const kinds = useContext(Known);
  if (!kinds) throw new Error('No kinds are provided around this component.');
  return kinds;
}

export const useKind = (name: string): Kind => useKinds().of(name);

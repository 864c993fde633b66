/** What is being chosen in the studios. The whole page holds it, so that a look at another page loses nothing. */

import { type ComponentChildren, createContext } from 'preact';
import { useContext, useState } from 'preact/hooks';

type Drafts = Readonly<Record<string, object>>;

const Held = createContext<readonly [Drafts, (change: (known: Drafts) => Drafts) => void]>([{}, () => undefined]);

export function DraftsProvider({ children }: { children: ComponentChildren }) {
  const held = useState<Drafts>({});
  return <Held.Provider value={held}>{children}</Held.Provider>;
}

/** What is chosen in the studio of a kind, at first nothing; and what changes a part of it. */
export function useDraft<T extends object>(kind: string, nothing: T): readonly [T, (part: Partial<T>) => void] {
  const [drafts, change] = useContext(Held);
  const alter = (part: Partial<T>): void => change((known) => ({ ...known, [kind]: { ...nothing, ...known[kind], ...part } }));
  return [(drafts[kind] as T | undefined) ?? nothing, alter];
}

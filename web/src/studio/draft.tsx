/** What is being chosen in the studios. The whole page holds it, so that a look at another page loses nothing. */

import { type ComponentChildren, createContext } from 'preact';
import { useContext, useState } from 'preact/hooks';

type Drafts = Readonly<Record<string, object>>;

const Held = createContext<readonly [Drafts, (change: (known: Drafts) => Drafts) => void]>([{}, () => undefined]);

export function DraftsProvider({ children }: { children: ComponentChildren }) {
  const held = useState<Drafts>({});
  return <Held.Provider value={held}>{children}</Held.Provider>;
}

/** A part of a draft; or what makes it of the draft as it is by then: a file is looked into before it is given. */
export type Change<T> = Partial<T> | ((draft: T) => Partial<T>);

/** What is chosen in the studio of a kind, at first nothing; and what changes a part of it. */
export function useDraft<T extends object>(kind: string, nothing: T): readonly [T, (part: Change<T>) => void] {
  const [drafts, change] = useContext(Held);
  const alter = (part: Change<T>): void =>
    change((known) => {
      const draft: T = { ...nothing, ...known[kind] };
      return { ...known, [kind]: { ...draft, ...(typeof part === 'function' ? part(draft) : part) } };
    });
  return [(drafts[kind] as T | undefined) ?? nothing, alter];
}

/** The page where something of a kind is ordered: what can be made, what is chosen for it, and the button that sends it. */

import type { ComponentChildren } from 'preact';
import { useEffect } from 'preact/hooks';
import type { Kind, Order } from '../kind/kind';
import { strings } from '../language/strings';
import { studioLink } from '../route';
import type { useSending } from '../sending/use_sending';
import { KindLinks } from './kind_links';
import { Launch } from './launch';

/** The start page is called like the whole. */
export function useStudioTitle({ label, link }: Kind): void {
  useEffect(() => {
    document.title = link === studioLink ? strings.name : `${label} · ${strings.name}`;
  }, []);
}

interface Props {
  kind: Kind;
  title: string;
  lead: string;
  /** Beside the title, what is made here, at a glance. */
  demo?: ComponentChildren;
  sending: ReturnType<typeof useSending>;
  /** What is still to be chosen; empty where nothing is. */
  missing: string;
  /** What is chosen, as an order; null while that is not enough for one. */
  order: (() => Order) | null;
  /** Of the button. */
  label: string;
  children: ComponentChildren;
}

export function StudioForm({ kind, title, lead, demo, sending, missing, order, label, children }: Props) {
  const start = (event: Event): void => {
    event.preventDefault();
    if (order && !missing) sending.begin(order());
  };
  return (
    <form class="studio" onSubmit={start}>
      <header>
        <div>
          <KindLinks current={kind.name} />
          <h1>{title}</h1>
          <p>{lead}</p>
        </div>
        {demo}
      </header>
      {children}
      <Launch kind={kind} sending={sending} missing={missing} chosen={order && kind.namesOf(order())} label={label} />
    </form>
  );
}

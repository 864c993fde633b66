/** What went wrong and what to do, in plain words. */

import type { ComponentChildren } from 'preact';
import { failureRemedy, failureTitle } from '../kind/failures';
import { useKinds } from '../kind/kinds';

interface Props {
  code: string;
  detail: string;
  children?: ComponentChildren;
}

export function ProblemAlert({ code, detail, children }: Props) {
  const { all } = useKinds();
  return (
    <div class="problem" role="alert">
      <strong>{failureTitle(all, code)}</strong>
      <p>{failureRemedy(code, detail)}</p>
      {children && <div class="actions">{children}</div>}
    </div>
  );
}

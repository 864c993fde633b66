/** What went wrong and what to do, in plain words. */

import type { ComponentChildren } from 'preact';
import { failureRemedy, failureTitle } from '../failures';

interface Props {
  code: string;
  detail: string;
  children?: ComponentChildren;
}

export function Trouble({ code, detail, children }: Props) {
  return (
    <div class="trouble" role="alert">
      <strong>{failureTitle(code)}</strong>
      <p>{failureRemedy(code, detail)}</p>
      {children && <div class="actions">{children}</div>}
    </div>
  );
}

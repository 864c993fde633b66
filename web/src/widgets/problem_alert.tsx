/** What went wrong and what to do, in plain words. */

import type { ComponentChildren } from 'preact';
import { failureRemedy, failureTitle } from '../kind/failures';
import { useKinds } from '../kind/kinds';
import type { Loading } from '../api/loading';
import { strings } from '../language/strings';

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

/** That something could not be fetched, with a button to try it again; nothing while all is well. */
export function LoadingProblem({ of: { problem, reload } }: { of: Pick<Loading<unknown>, 'problem' | 'reload'> }) {
  if (!problem) return null;
  return (
    <ProblemAlert code={problem.code} detail={problem.detail}>
      <button type="button" class="button" onClick={reload}>
        {strings.retry}
      </button>
    </ProblemAlert>
  );
}

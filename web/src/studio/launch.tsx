/** The end of a form that orders something: what an earlier page left, what went wrong, how far it is, or the button. */

import type { Kind, OrderNames } from '../kind/kind';
import { useKinds } from '../kind/kinds';
import type { useSending } from '../sending/use_sending';
import { strings } from '../language/strings';
import { SendingBar } from './sending_bar';
import { SubmitRow } from './submit_row';
import { ProblemAlert } from '../widgets/problem_alert';

const words = strings.studio;

interface Props {
  kind: Kind;
  sending: ReturnType<typeof useSending>;
  /** What is still to be chosen; empty where nothing is. */
  missing: string;
  /** What the order will be called, once all is chosen. */
  chosen: OrderNames | null;
  label: string;
}

export function Launch({ kind, sending, missing, chosen, label }: Props) {
  const kinds = useKinds();
  const { waiting } = sending;
  const left = waiting && kinds.of(waiting.kind).namesOf(waiting);
  return (
    <div class="launch">
      {waiting && left && (
        <div class="waiting" role="status">
          <p>{words.waiting(left.picture, left.performance)}</p>
          <div class="actions">
            <button type="button" class="button primary" onClick={() => sending.begin(waiting)}>
              {words.goOn}
            </button>
            <button type="button" class="button quiet" onClick={sending.forget}>
              {words.forget}
            </button>
          </div>
        </div>
      )}
      {sending.problem && (
        <ProblemAlert code={sending.problem.code} detail={sending.problem.detail}>
          <button type="button" class="button" onClick={sending.retry}>
            {strings.retry}
          </button>
        </ProblemAlert>
      )}
      {sending.step ? (
        <SendingBar files={kind.files} step={sending.step} paused={sending.paused} onPause={sending.pause} onStop={sending.stop} />
      ) : (
        <SubmitRow
          hint={missing || (chosen ? words.chosen(chosen.picture, chosen.performance) : '')}
          disabled={missing !== ''}
          label={label}
        />
      )}
    </div>
  );
}

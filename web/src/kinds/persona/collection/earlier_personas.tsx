/** Personas that were made before, to choose one that plays something else. */

import { useKind } from '../../../kind/kinds';
import { Poster } from '../../../works/entry';
import { workName } from '../../../works/names';
import { useWorks } from '../../../works/works';
import { LoadingProblem } from '../../../widgets/problem_alert';
import type { Earlier } from '../order';
import { words as personaWords } from '../words';

const words = personaWords.studio;
const KINDS = ['persona'];
const AT_ONCE = 12;

interface Props {
  /** Of the job that made it. */
  chosen: string | null;
  onChoose: (persona: Earlier) => void;
}

export function EarlierPersonas({ chosen, onChoose }: Props) {
  const kind = useKind('persona');
  const { jobs, more, problem, retry } = useWorks(AT_ONCE, { kinds: KINDS, status: 'succeeded', words: '' });
  return (
    <>
      <p class="hint">{words.earlierHint}</p>
      <LoadingProblem of={{ problem, reload: retry }} />
      {jobs?.length === 0 && <p>{words.earlierNone}</p>}
      <fieldset class="earlier" aria-busy={!jobs}>
        <legend class="visually-hidden">{words.earlier}</legend>
        <div class="cards">
          {jobs?.map((job) => (
            <label key={job.id} class={job.id === chosen ? 'card checked' : 'card'}>
              <input
                type="radio"
                name="persona"
                value={job.id}
                checked={job.id === chosen}
                onChange={() => onChoose({ id: job.id, name: workName(job, kind) })}
              />
              <Poster job={job} />
              <span>{workName(job, kind)}</span>
            </label>
          ))}
        </div>
      </fieldset>
      {more && (
        <button type="button" class="button" onClick={() => void more()}>
          {words.earlierMore}
        </button>
      )}
    </>
  );
}

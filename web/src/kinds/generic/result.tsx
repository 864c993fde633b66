/** What a finished job of any kind has left. */

import { size } from '../../language/format';
import { ElapsedTime, ResultActions, Warnings } from '../../result/actions';
import { useKind } from '../../kind/kinds';
import type { ResultProps } from '../../kind/kind';
import { ShownArtifacts, shownIn } from './artifacts';

export default function GenericResult({ job, report }: ResultProps) {
  const kind = useKind(job.kind);
  const [main] = shownIn(job.artifacts);
  const file = main === undefined ? undefined : job.artifacts[main];
  return (
    <div class="result">
      <ShownArtifacts artifacts={job.artifacts} alt={kind.shared.alt} />
      <ResultActions job={job} filesOpen={!file}>
        {main !== undefined && file && (
          <a class="button primary" href={file.url} download={main}>
            {main} <small>{size(file.size)}</small>
          </a>
        )}
      </ResultActions>
      <Warnings report={report} />
      <ElapsedTime job={job} />
    </div>
  );
}

/** What a finished job of any kind has left. */

import { getReport } from '../../api';
import { size } from '../../format';
import { useLoaded } from '../../loading';
import { ElapsedTime, ResultActions, Warnings } from '../../result/actions';
import { kindOf } from '..';
import type { ResultProps } from '../../kind';
import { ShownArtifacts, shownIn } from './artifacts';

export default function GenericResult({ job }: ResultProps) {
  const report = useLoaded((signal) => getReport(job, signal), job.id);
  const [main] = shownIn(job.artifacts);
  const file = main === undefined ? undefined : job.artifacts[main];
  return (
    <div class="result">
      <ShownArtifacts artifacts={job.artifacts} alt={kindOf(job.kind).shared.alt} />
      <ResultActions job={job} filesOpen={!file}>
        {main !== undefined && file && (
          <a class="button primary" href={file.url} download={main}>
            {main} <small>{size(file.size)}</small>
          </a>
        )}
      </ResultActions>
      <Warnings report={report.value} />
      <ElapsedTime job={job} />
    </div>
  );
}

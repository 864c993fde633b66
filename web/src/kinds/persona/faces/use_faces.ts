/** The faces that a job has found, and the sheet of their pictures; null until both are there. */

import { type Job, readArtifact } from '../../../api';
import { useLoaded } from '../../../api/loading';
import { useSteadyUrl } from '../../../widgets/steady_url';
import type { FaceSheet } from '../types';

export interface Faces {
  sheet: FaceSheet;
  url: string;
}

export function useFaces(job: Job): Faces | null {
  const listed = job.artifacts['faces.json'];
  const url = useSteadyUrl(job.artifacts['faces.jpg']);
  const sheet = useLoaded((signal) => readArtifact<FaceSheet>(job, 'faces.json', signal), listed?.sha256 ?? '').value;
  return sheet && url !== undefined ? { sheet, url } : null;
}

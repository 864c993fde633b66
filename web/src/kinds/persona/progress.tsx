/** What is known of a persona while it is made: the average of the photos so far, and the faces that were found. */

import type { ProgressProps } from '../../kind/kind';
import { useSteadyUrl } from '../../widgets/steady_url';
import { FaceList } from './faces/face_list';
import { useFaces } from './faces/use_faces';
import { words as personaWords } from './words';
import './styles/progress.css';

const words = personaWords.faces;

export default function PersonaProgress({ job }: ProgressProps) {
  const faces = useFaces(job);
  const average = useSteadyUrl(job.artifacts['average.png']);
  if (!faces && !average) return null;
  return (
    <div class="persona-progress">
      {average && (
        <figure class="panel">
          <img src={average} alt={words.averageSoFar} />
          <figcaption>{words.averageSoFar}</figcaption>
        </figure>
      )}
      {faces && <FaceList faces={faces} />}
    </div>
  );
}

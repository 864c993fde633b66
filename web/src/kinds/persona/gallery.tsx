/** The expressions that a collection shows itself, each with how many photos come near it. */

import { type Job, readArtifact } from '../../api';
import { useLoaded } from '../../api/loading';
import { plain } from '../../language/strings';
import { cellStyle } from '../../widgets/sheet_cell';
import { useSteadyUrl } from '../../widgets/steady_url';
import type { Gallery } from './types';
import { words as personaWords } from './words';

const words = personaWords.show;

export function ExpressionGallery({ job }: { job: Job }) {
  const url = useSteadyUrl(job.artifacts['gallery.jpg']);
  const told = useLoaded((signal) => readArtifact<Gallery>(job, 'gallery.json', signal), job.id).value;
  if (!url || !told) return <div class="panel" aria-busy="true" />;
  const pictures = { columns: told.columns, count: told.shown.length, cell: told.tile };
  const rare = told.left_out.map(({ name, photos }) => nameOf(name, photos)).join(', ');
  return (
    <section class="panel" aria-label={words.names.gallery}>
      <p class="hint">{words.captions.gallery}</p>
      <ul class="expression-gallery">
        {told.shown.map(({ name, photos }, place) => (
          <li key={name}>
            <span role="img" aria-label={nameOf(name)} style={cellStyle(pictures, url, place)} />
            <span aria-hidden="true">{nameOf(name, photos)}</span>
          </li>
        ))}
      </ul>
      {rare && <p class="hint">{words.rare(told.photos_needed, rare)}</p>}
    </section>
  );
}

function nameOf(name: string, photos?: number): string {
  const expression = words.expressions[name] ?? plain(name);
  return photos === undefined ? expression : words.ofPhotos(expression, photos);
}

/** The faces that were found in a collection: those that are used, and the others with the reasons. */

import { cellStyle } from '../../../widgets/sheet_cell';
import { plain } from '../../../language/strings';
import { picturesOf } from '../types';
import { words as personaWords } from '../words';
import { groupsOf } from './face_groups';
import type { Faces } from './use_faces';
import '../styles/faces.css';

const words = personaWords.faces;

export const groupTitle = (reason: string | null, count: number): string =>
  reason === null ? words.used(count) : words.reason((words.reasons as Record<string, string>)[reason] ?? plain(reason), count);

export function FaceList({ faces: { sheet, url } }: { faces: Faces }) {
  const pictures = picturesOf(sheet);
  return (
    <section class="panel face-list" aria-label={words.found}>
      <h2>{words.found}</h2>
      {groupsOf(sheet).map(({ reason, faces }) => (
        <figure key={reason}>
          <figcaption>{groupTitle(reason, faces.length)}</figcaption>
          <div class="face-cells" role="img" aria-label={groupTitle(reason, faces.length)}>
            {faces.map((number) => (
              <span key={number} title={sheet.faces[number]?.photo} style={cellStyle(pictures, url, number)} />
            ))}
          </div>
        </figure>
      ))}
      {sheet.skipped.length > 0 && (
        <details>
          <summary>{words.skipped(sheet.skipped.length)}</summary>
          <ul class="plain">
            {sheet.skipped.map(({ file }) => (
              <li key={file}>{file}</li>
            ))}
          </ul>
        </details>
      )}
    </section>
  );
}

/** What a public link opens, for whoever was given it. */

import { getShared, type Shared } from '../api';
import { Heading } from '../widgets/heading';
import { useKinds, useKind } from '../kind/kinds';
import { part } from '../widgets/lazy';
import { Player } from '../result/player';
import { ProblemAlert } from '../widgets/problem_alert';
import { moment, size } from '../language/format';
import { useLoaded } from '../api/loading';
import { strings } from '../language/strings';
import '../styles/share.css';

const words = strings.shared;

/** What the page itself needs, for whom all files are not meant. */
const PAGE_ONLY_FILES = /^(poster\.jpg|skeleton\.json|background\.png|puppet_textures\.(jpg|json))$/;

export default function SharedPage({ token }: { token: string }) {
  const kinds = useKinds();
  const { value: shared, problem } = useLoaded((signal) => getShared(token, signal), token);
  if (problem?.status === 404) {
    return (
      <article class="shared">
        <Heading text={words.gone} />
        <p>{words.goneDetail}</p>
      </article>
    );
  }
  if (problem) return <ProblemAlert code={problem.code} detail={problem.detail} />;
  if (!shared) return <div aria-busy="true" />;

  const kind = kinds.of(shared.kind);
  const files = Object.entries(shared.artifacts);
  const taken = kind.shared.downloads.flatMap(([like, label]) => files.filter(([name]) => like.test(name)).map((file) => ({ file, label })));
  const others = files.filter(([name]) => !PAGE_ONLY_FILES.test(name) && !taken.some(({ file }) => file[0] === name));
  const listed = others.length ? files : [];
  return (
    <article class="shared">
      <Heading text={shared.title ?? kind.shared.title} />
      <Result token={token} shared={shared} />
      <div class="actions">
        {taken.map(({ file: [name, { url, size: bytes }], label }, index) => (
          <a key={name} class={index ? 'button' : 'button primary'} href={url} download={name}>
            {label} <small>{size(bytes)}</small>
          </a>
        ))}
      </div>
      {listed.length > 0 && (
        <ul class="plain">
          {listed.map(([name, file]) => (
            <li key={name}>
              <a href={file.url} download={name}>
                {name}
              </a>{' '}
              <small>{size(file.size)}</small>
            </li>
          ))}
        </ul>
      )}
      {shared.expires_at && <p class="hint">{strings.share.until(moment(shared.expires_at))}</p>}
    </article>
  );
}

/** The animation, and whatever else the kind has to show. */
function Result({ token, shared }: { token: string; shared: Shared }) {
  const { loadShared } = useKind(shared.kind);
  const film = filmOf(shared) && <Film shared={shared} />;
  if (!loadShared) return film ?? null;
  const renew = (signal: AbortSignal): Promise<Shared> => getShared(token, signal);
  const Shown = part(loadShared);
  return <Shown shared={shared} renew={renew} film={film} />;
}

const filmOf = ({ artifacts }: Shared) =>
  Object.entries(artifacts).find(([name, { content_type: type }]) => name.startsWith('animation.') && !/zip/.test(type))?.[1];

function Film({ shared }: { shared: Shared }) {
  const { alt, hasSound } = useKind(shared.kind).shared;
  const film = filmOf(shared);
  if (!film) return null;
  if (film.content_type.startsWith('image/')) {
    return (
      <figure>
        <img src={film.url} alt={alt} />
      </figure>
    );
  }
  return (
    <Player
      label={strings.job.result}
      alt={alt}
      result={film.url}
      poster={shared.artifacts['poster.jpg']?.url}
      driver={null}
      chosen={null}
      start={0}
      hasSound={shared.has_sound ?? hasSound}
    />
  );
}

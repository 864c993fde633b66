/** What a public link opens, for whoever was given it. */

import { getShared, type Shared } from '../api';
import { Heading } from '../components/heading';
import { later } from '../components/later';
import { Player } from '../components/player';
import { Trouble } from '../components/trouble';
import { moment, size } from '../format';
import { useLoaded } from '../loading';
import { strings } from '../strings';
import '../styles/share.css';

const Viewer = later(() => import('../viewer/panel'));
const words = strings.shared;

/** Files that most people have a use for, by how they begin; the rest is listed. */
const TAKEN: readonly [name: RegExp, label: string][] = [
  [/^character\.glb$/, strings.character.glb],
  [/^character\.usdz$/, strings.character.usdz],
  [/^animation\./, strings.job.download],
];
/** What the page itself needs, for whom all files are not meant. */
const INNER = /^(poster\.jpg|skeleton\.json|background\.png)$/;

export default function SharedPage({ token }: { token: string }) {
  const { value: shared, problem } = useLoaded((signal) => getShared(token, signal), token);
  if (problem?.status === 404) {
    return (
      <article class="shared">
        <Heading text={words.gone} />
        <p>{words.goneDetail}</p>
      </article>
    );
  }
  if (problem) return <Trouble code={problem.code} detail={problem.detail} />;
  if (!shared) return <div aria-busy="true" />;

  const files = Object.entries(shared.artifacts);
  const taken = TAKEN.flatMap(([like, label]) => files.filter(([name]) => like.test(name)).map((file) => ({ file, label })));
  const others = files.filter(([name]) => !INNER.test(name) && !taken.some(({ file }) => file[0] === name));
  const listed = others.length ? files : [];
  return (
    <article class="shared">
      <Heading text={shared.title ?? (shared.kind === 'character' ? words.titleCharacter : words.title)} />
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

/** A character in 3D, its video at hand; of a portrait the video. */
function Result({ token, shared }: { token: string; shared: Shared }) {
  const { artifacts } = shared;
  const film = <Film shared={shared} />;
  if (!artifacts['character.glb']) return film;
  const renew = (signal: AbortSignal): Promise<Shared> => getShared(token, signal);
  return <Viewer job={shared} renew={renew} first="wall" film={filmOf(shared) ? film : undefined} />;
}

const filmOf = ({ artifacts }: Shared) =>
  Object.entries(artifacts).find(([name, { content_type: type }]) => name.startsWith('animation.') && !/zip/.test(type))?.[1];

function Film({ shared }: { shared: Shared }) {
  const film = filmOf(shared);
  if (!film) return null;
  const ofCharacter = shared.kind === 'character';
  const alt = ofCharacter ? strings.character.result : strings.job.resultAlt;
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
      hasSound={shared.has_sound ?? false}
    />
  );
}

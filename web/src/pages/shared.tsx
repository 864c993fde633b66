/** What a public link opens, for whoever was given it. */

import { getShared } from '../api';
import { Heading } from '../components/heading';
import { Trouble } from '../components/trouble';
import { moment, size } from '../format';
import { useLoaded } from '../loading';
import { strings } from '../strings';
import '../styles/share.css';

const words = strings.shared;

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

  const ofCharacter = shared.kind === 'character';
  const alt = ofCharacter ? strings.character.result : strings.job.resultAlt;
  const files = Object.entries(shared.artifacts);
  const animation = files.find(([name, { content_type: type }]) => name.startsWith('animation.') && !/zip/.test(type));
  return (
    <article class="shared">
      <Heading text={ofCharacter ? words.titleCharacter : words.title} />
      {animation && (
        <figure>
          {animation[1].content_type.startsWith('image/') ? (
            <img src={animation[1].url} alt={alt} />
          ) : (
            <video
              src={animation[1].url}
              poster={shared.artifacts['poster.jpg']?.url}
              controls
              loop
              playsInline
              aria-label={alt}
            />
          )}
        </figure>
      )}
      <div class="actions">
        {animation && (
          <a class="button primary" href={animation[1].url} download={animation[0]}>
            {strings.job.download} <small>{size(animation[1].size)}</small>
          </a>
        )}
      </div>
      {files.length > 2 && (
        <ul class="plain">
          {files.map(([name, file]) => (
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

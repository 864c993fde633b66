/** Pictures to begin with: one click puts one where a file of one's own would be. */

import { useId, useState } from 'preact/hooks';
import { figureSamples, isSample, sampleFile, type SampleName, smallUrl } from './sample_pictures';
import { strings } from '../strings';

const words = strings.samples;
const isFigure = (name: SampleName): boolean => (figureSamples as readonly SampleName[]).includes(name);

interface Props {
  names: readonly SampleName[];
  chosen: File | null;
  onChoose: (file: File) => void;
}

export function Samples({ names, chosen, onChoose }: Props) {
  const label = useId();
  const [failed, setFailed] = useState(false);
  const choose = (name: SampleName): void => {
    setFailed(false);
    sampleFile(name).then(onChoose, () => setFailed(true));
  };
  return (
    <div class="samples" role="group" aria-labelledby={label}>
      <h3 id={label}>{words.label}</h3>
      <div>
        {names.map((name) => (
          <button key={name} type="button" aria-pressed={isSample(chosen, name)} title={words.names[name]} onClick={() => choose(name)}>
            <img src={smallUrl(name)} alt={words.names[name]} width="88" height={isFigure(name) ? 117 : 88} />
          </button>
        ))}
      </div>
      {failed && (
        <p class="error" role="alert">
          {words.failed}
        </p>
      )}
    </div>
  );
}

/** Pictures to begin with: one click puts one where a file of one's own would be. */

import { useId, useState } from 'preact/hooks';
import { strings } from '../../language/strings';
import { isSample, sampleFile, type SamplePicture, smallUrl } from './sample_pictures';

const words = strings.samples;

interface Props {
  samples: readonly SamplePicture[];
  chosen: File | null;
  onChoose: (file: File) => void;
}

export function Samples({ samples, chosen, onChoose }: Props) {
  const label = useId();
  const [failed, setFailed] = useState(false);
  const choose = (sample: SamplePicture): void => {
    setFailed(false);
    sampleFile(sample).then(onChoose, () => setFailed(true));
  };
  return (
    <div class="samples" role="group" aria-labelledby={label}>
      <h3 id={label}>{words.label}</h3>
      <div>
        {samples.map((sample) => (
          <button
            key={sample.name}
            type="button"
            aria-pressed={isSample(chosen, sample)}
            title={sample.alt}
            onClick={() => choose(sample)}
          >
            <img src={smallUrl(sample)} alt={sample.alt} width="88" height={sample.smallHeight} />
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

/** Whose likeness is given: nothing is begun before somebody has said that the person agreed. */

import { useId } from 'preact/hooks';
import { Checkbox } from '../widgets/checkbox';

interface Props {
  words: {
    consentTitle: string;
    /** What is made of it, and what the law has to say; a paragraph each. */
    consent: readonly string[];
    agreed: string;
  };
  given: boolean;
  onChange: (given: boolean) => void;
}

export function Consent({ words, given, onChange }: Props) {
  const id = useId();
  return (
    <div class="consent" role="group" aria-labelledby={id}>
      <h3 id={id}>{words.consentTitle}</h3>
      {words.consent.map((paragraph) => (
        <p key={paragraph}>{paragraph}</p>
      ))}
      <Checkbox label={words.agreed} checked={given} onChange={onChange} />
    </div>
  );
}

/** Whose body it is that is filmed: nothing is begun before somebody has said that the person agreed. */

import { Checkbox } from '../../widgets/checkbox';
import { words as avatarWords } from './words';

const words = avatarWords.studio;

interface Props {
  given: boolean;
  onChange: (given: boolean) => void;
}

export function Consent({ given, onChange }: Props) {
  return (
    <div class="consent">
      <h3>{words.consentTitle}</h3>
      <p>{words.consent}</p>
      <Checkbox label={words.agreed} checked={given} onChange={onChange} />
    </div>
  );
}

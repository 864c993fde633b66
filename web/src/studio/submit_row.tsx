/** The button that sends a form, and beside it what is still missing for that, or what will be made. */

import { useId } from 'preact/hooks';

interface Props {
  hint: string;
  disabled: boolean;
  /** Of the button. */
  label: string;
}

export function SubmitRow({ hint, disabled, label }: Props) {
  const id = useId();
  return (
    <div class="submit-row">
      <p id={id} class="hint" aria-live="polite">
        {hint}
      </p>
      <button type="submit" class="button primary large" disabled={disabled} aria-describedby={id}>
        {label}
      </button>
    </div>
  );
}

/** A row of buttons of which one is on. */

interface Props<Choice extends string | number> {
  /** What is chosen by it, where nothing around it says so. */
  label?: string;
  choices: readonly Choice[];
  name: (choice: Choice) => string;
  chosen: Choice | undefined;
  disabled?: boolean;
  /** A class of its own beside `actions`. */
  class?: string;
  onChoose: (choice: Choice) => void;
}

export function Toggles<Choice extends string | number>({
  label,
  choices,
  name,
  chosen,
  disabled = false,
  class: own = '',
  onChoose,
}: Props<Choice>) {
  return (
    <div class={`actions ${own}`.trim()} role={label === undefined ? undefined : 'group'} aria-label={label}>
      {choices.map((one) => (
        <button key={one} type="button" class="toggle" aria-pressed={one === chosen} disabled={disabled} onClick={() => onChoose(one)}>
          {name(one)}
        </button>
      ))}
    </div>
  );
}

/** One of several that are chosen from, as a card with a drawing. Those of a form exclude each other. */

interface Props {
  value: string;
  /** A path in a square of 48. */
  symbol: string;
  label: string;
  hint?: string;
  checked: boolean;
  onChoose: () => void;
}

export function SymbolCard({ value, symbol, label, hint, checked, onChoose }: Props) {
  return (
    <label class={checked ? 'card checked' : 'card'} title={hint}>
      <input type="radio" name="performance" value={value} checked={checked} onChange={onChoose} />
      <svg viewBox="0 0 48 48" aria-hidden="true">
        <path d={symbol} />
      </svg>
      <span>{label}</span>
    </label>
  );
}

/** The tools that every stage has: a nearer or further view, and the way back. */

import { strings } from '../language/strings';
import { canRedo, canUndo, type History, type Step } from './history';

const words = strings.stage;

interface ToolProps {
  label: string;
  icon: string;
  disabled?: boolean;
  /** For a tool that is on or off. */
  pressed?: boolean;
  onUse: () => void;
}

export function Tool({ label, icon, disabled = false, pressed, onUse }: ToolProps) {
  return (
    <button
      type="button"
      class="tool"
      aria-label={label}
      aria-pressed={pressed}
      title={label}
      disabled={disabled}
      onClick={onUse}
    >
      <svg viewBox="0 0 24 24" width="22" height="22" aria-hidden="true">
        <path d={icon} />
      </svg>
    </button>
  );
}

/** `onZoom` is given a factor, or null for the whole picture. */
export function ZoomTools({ onZoom }: { onZoom: (factor: number | null) => void }) {
  const glass = 'M10.5 4a6.5 6.5 0 1 1 0 13 6.5 6.5 0 0 1 0-13m5 11 5 5M7.5 10.5h6';
  return (
    <span class="cluster">
      <Tool label={words.zoomOut} onUse={() => onZoom(1 / 1.5)} icon={glass} />
      <Tool label={words.zoomIn} onUse={() => onZoom(1.5)} icon={`${glass}m-3-3v6`} />
      <Tool label={words.fit} onUse={() => onZoom(null)} icon="M4 5h16v14H4zm5 4h6v6H9z" />
    </span>
  );
}

interface HistoryProps<State> {
  history: History<State>;
  advance: (step: Step<State>) => void;
}

export function HistoryTools<State>({ history, advance }: HistoryProps<State>) {
  return (
    <span class="cluster">
      <Tool
        label={words.undo}
        disabled={!canUndo(history)}
        onUse={() => advance({ type: 'undo' })}
        icon="M8 5 3.5 9.5 8 14M4 9.5h10a5.5 5.5 0 0 1 0 11H9"
      />
      <Tool
        label={words.redo}
        disabled={!canRedo(history)}
        onUse={() => advance({ type: 'redo' })}
        icon="m16 5 4.5 4.5L16 14m4-4.5H10a5.5 5.5 0 0 0 0 11h5"
      />
    </span>
  );
}

/** What a key with Ctrl or Command does to the history; undefined where it is another key. */
export function historyKey<State>(event: KeyboardEvent, advance: (step: Step<State>) => void): (() => void) | undefined {
  if (!event.ctrlKey && !event.metaKey) return undefined;
  const letter = event.key.toLowerCase();
  if (letter === 'z') return () => advance({ type: event.shiftKey ? 'redo' : 'undo' });
  return letter === 'y' ? () => advance({ type: 'redo' }) : undefined;
}

interface FooterProps {
  canReset: boolean;
  onReset: () => void;
  onCancel: () => void;
  onDone: () => void;
}

export function StageFooter({ canReset, onReset, onCancel, onDone }: FooterProps) {
  return (
    <footer class="actions">
      <button type="button" class="button quiet" disabled={!canReset} onClick={onReset}>
        {words.reset}
      </button>
      <span class="spacer" />
      <button type="button" class="button" onClick={onCancel}>
        {words.cancel}
      </button>
      <button type="button" class="button primary" onClick={onDone}>
        {words.done}
      </button>
    </footer>
  );
}

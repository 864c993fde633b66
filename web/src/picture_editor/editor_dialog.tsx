/** A window in which something is edited over a picture: tools above, words and what to do with it below. */

import type { ComponentChildren } from 'preact';
import { Dialog } from '../widgets/dialog';
import type { History, Step } from './history';
import { HistoryTools, StageFooter, ZoomTools } from './tools';
import '../styles/picture_editor.css';

interface Props<State> {
  title: string;
  /** What the tools are called, and those that the others do not have. */
  toolsLabel: string;
  tools?: ComponentChildren;
  history: History<State>;
  advance: (next: Step<State>) => void;
  onZoom: (factor: number | null) => void;
  /** What describes the stage: the id that it has there, and the words. */
  help: { id: string; text: string; keys: string };
  canReset: boolean;
  onReset: () => void;
  onClose: () => void;
  onDone: () => void;
  /** The stage, and what is said below it. */
  children: [stage: ComponentChildren, said: ComponentChildren];
}

export function EditorDialog<State>(props: Props<State>) {
  const { title, toolsLabel, tools, history, advance, onZoom, help, children } = props;
  const [stage, said] = children;
  return (
    <Dialog title={title} onClose={props.onClose}>
      <div class="picture-editor-tools" role="toolbar" aria-label={toolsLabel}>
        {tools}
        <ZoomTools onZoom={onZoom} />
        <HistoryTools history={history} advance={advance} />
      </div>
      {stage}
      <p class="picture-editor-help" id={help.id}>
        {help.text} <span class="keys">{help.keys}</span>
      </p>
      {said}
      <StageFooter
        canReset={props.canReset}
        onReset={props.onReset}
        onCancel={props.onClose}
        onDone={props.onDone}
      />
    </Dialog>
  );
}

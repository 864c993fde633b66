/** MaskOverlay over what was cut out, or over the parts of the body: a window of its own over the page. */

import { useId, useState } from 'preact/hooks';
import type { BodyPart } from '../types';
import { Checkbox } from '../../../widgets/checkbox';
import { act, arrows, useEditing, zoomKeys } from '../../../picture_editor/editing';
import { EditorDialog } from '../../../picture_editor/editor_dialog';
import type { Point } from '../../../picture_editor/geometry';
import { type Drag, Surface, type Touch } from '../../../picture_editor/surface';
import { Tool } from '../../../picture_editor/tools';
import { bodyParts } from '../choices';
import { MaskOverlay } from './mask_overlay';
import { type LabelStroke, type MaskStroke, partColours, radii, simplified } from './strokes';
import { words as characterWords } from '../words';
import '../styles/mask_editor.css';

const words = characterWords.painter;

/** How far one press of a key moves, as a share of the picture's longer side. */
const NUDGE = 1 / 300;
/** How many times as far it moves with Shift. */
const SHIFT_FACTOR = 8;
/** How many times as wide one press of a key makes the brush. */
const WIDER = 1.2;

type AnyStroke = MaskStroke | LabelStroke;
/** What a stroke says of what it covers. */
type Saying = { person: boolean } | { part: BodyPart };

interface Props {
  url: string;
  size: readonly [width: number, height: number];
  what: 'mask' | 'labels';
  /** Where mask.png and labels.png are. */
  mask: string;
  labels: string;
  /** The strokes that these two do not show yet. */
  fresh: { mask: readonly MaskStroke[]; labels: readonly LabelStroke[] };
  onDone: (strokes: readonly AnyStroke[]) => void;
  onClose: () => void;
}

export default function MaskEditor({ url, size, what, mask, labels, fresh, onDone, onClose }: Props) {
  const start: readonly AnyStroke[] = fresh[what];
  const { history, advance, state: strokes, change, view, setView, zoom } = useEditing(size, start);
  const range = radii(size);
  const [radius, setRadius] = useState(range.usual);
  const [saying, setSaying] = useState<Saying>(what === 'mask' ? { person: true } : { part: 'left_arm' });
  const [carrying, setCarrying] = useState(false);
  const [coloured, setColoured] = useState(true);
  const [brush, setBrush] = useState<Point | null>(null);
  const [down, setDown] = useState(false);
  const help = useId();

  const strokeOf = (path: [number, number][]): AnyStroke => ({ path, radius, ...saying }) as AnyStroke;
  const widen = (by: number): void => setRadius(Math.min(range.max, Math.max(range.min, radius * by)));
  const middle: Point = [view.x + view.width / 2, view.y + view.height / 2];
  const zoomTo = (factor: number | null): void => zoom(factor, brush ?? middle);

  const grasp = ({ at: from }: Touch): Drag | null => {
    if (carrying) return null;
    let stroke = strokeOf([[...from]]);
    const put = (last: AnyStroke): void => advance({ type: 'change', state: [...strokes, last] });
    advance({ type: 'begin' });
    put(stroke);
    return {
      move: (at) => {
        setBrush(at);
        stroke = { ...stroke, path: [...stroke.path, [...at]] };
        put(stroke);
      },
      end: () => put(simplified(stroke)),
      cancel: () => advance({ type: 'change', state: strokes }),
    };
  };

  /** The brush led by keys: while it is set down, it paints. */
  const lead = (dx: number, dy: number): void => {
    const [x, y] = brush ?? middle;
    const at: Point = [
      Math.min(size[0] - 1, Math.max(0, x + dx)),
      Math.min(size[1] - 1, Math.max(0, y + dy)),
    ];
    setBrush(at);
    const last = strokes.at(-1);
    if (down && last) advance({ type: 'change', state: [...strokes.slice(0, -1), { ...last, path: [...last.path, [...at]] }] });
  };
  const setOrLift = (): void => {
    const at = brush ?? middle;
    setBrush(at);
    if (down) {
      const last = strokes.at(-1);
      if (last) advance({ type: 'change', state: [...strokes.slice(0, -1), simplified(last)] });
    } else {
      change([...strokes, strokeOf([[...at]])]);
    }
    setDown(!down);
  };
  const back = (action: typeof advance): typeof advance => (taken) => {
    setDown(false);
    action(taken);
  };
  const key = (event: KeyboardEvent): void => {
    const unit = Math.max(...size) * NUDGE * (event.shiftKey ? SHIFT_FACTOR : 1);
    const actions = {
      ...arrows(unit, lead),
      ...zoomKeys(zoomTo),
      ' ': setOrLift,
      '[': () => widen(1 / WIDER),
      ']': () => widen(WIDER),
    };
    act(event, actions, back(advance));
  };

  const shown = { ...fresh, [what]: strokes };
  return (
    <EditorDialog
      title={what === 'mask' ? words.maskTitle : words.labelsTitle}
      toolsLabel={words.tools}
      tools={
        <>
          <Paints what={what} value={saying} onChange={(next) => (setSaying(next), setDown(false))} />
          <label class="inline brush-size">
            <span>{words.size}</span>
            <input
              type="range"
              min={Math.log(range.min)}
              max={Math.log(range.max)}
              step="any"
              value={Math.log(radius)}
              aria-label={words.size}
              aria-valuetext={`${Math.round(2 * radius)} px`}
              onInput={({ currentTarget }) => setRadius(Math.exp(currentTarget.valueAsNumber))}
            />
          </label>
          <Checkbox label={words.overlay} checked={coloured} onChange={setColoured} />
          <span class="cluster">
            <Tool
              label={words.drag}
              pressed={carrying}
              onUse={() => setCarrying(!carrying)}
              icon="M12 3v18M3 12h18M12 3 9 6m3-3 3 3M12 21l-3-3m3 3 3-3M3 12l3-3m-3 3 3 3M21 12l-3-3m3 3-3 3"
            />
          </span>
        </>
      }
      history={history}
      advance={back(advance)}
      onZoom={zoomTo}
      help={{ id: help, text: words.help, keys: words.keys }}
      canReset={strokes.length > 0}
      onReset={() => {
        setDown(false);
        change([]);
      }}
      onClose={onClose}
      onDone={() => onDone(strokes.map(simplified))}
    >
      <Surface
        class={carrying ? 'mask-editor panning' : 'mask-editor'}
        size={size}
        view={view}
        label={words.stage}
        help={help}
        onGrasp={grasp}
        onHover={setBrush}
        onView={setView}
        onKey={key}
      >
        <MaskOverlay url={url} size={size} what={coloured ? what : null} mask={mask} labels={labels} strokes={shown} />
        {brush && !carrying && <circle class={down ? 'brush down' : 'brush'} cx={brush[0]} cy={brush[1]} r={radius} />}
      </Surface>
      <p class="visually-hidden" role="status">
        {down ? words.down : brush ? words.up : ''}
      </p>
    </EditorDialog>
  );
}

interface PaintsProps {
  what: 'mask' | 'labels';
  value: Saying;
  onChange: (value: Saying) => void;
}

/** What the brush says of what it covers. */
function Paints({ what, value, onChange }: PaintsProps) {
  const sayings: { saying: Saying; label: string; colour: string }[] =
    what === 'mask'
      ? [
          { saying: { person: true }, label: words.add, colour: 'transparent' },
          { saying: { person: false }, label: words.remove, colour: 'rgb(200 30 70)' },
        ]
      : bodyParts.map((part) => ({
          saying: { part },
          label: characterWords.character.parts[part],
          colour: partColours[part],
        }));
  const keyOf = (saying: Saying): string => JSON.stringify(saying);
  return (
    <div class="paints" role="radiogroup" aria-label={words.paints}>
      {sayings.map(({ saying, label, colour }) => (
        <label key={keyOf(saying)}>
          <input
            type="radio"
            name="paints"
            checked={keyOf(saying) === keyOf(value)}
            onChange={() => onChange(saying)}
          />
          <span>
            <i style={{ background: colour }} aria-hidden="true" />
            {label}
          </span>
        </label>
      ))}
    </div>
  );
}

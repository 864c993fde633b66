/** How large a video is, how many frames it has, and of which kind it is. */

import { strings } from '../language/strings';
import { SelectField } from '../widgets/select';

/** Width and height to fit into, in pixels; null for the picture's own. */
export type Size = [width: number, height: number] | null;
export type Format = 'mp4' | 'webm' | 'webp' | 'gif' | 'png';

const words = strings.video;
const sizes: readonly Size[] = [null, [512, 512], [1024, 1024], [1920, 1920]];
const rates = [24, 25, 30, 50, 60] as const;
/** Those that browsers show. */
const formats = ['mp4', 'webm', 'webp'] as const;

interface Props<Value> {
  value: Value;
  onChange: (value: Value) => void;
}

/** `own` says what the picture's own size is. */
export function SizeField({ own, ...field }: Props<Size> & { own: string }) {
  return <SelectField label={words.size} choices={sizes} nameOf={(size) => (size ? words.sizeUpTo(size[0]) : own)} {...field} />;
}

/** Frames a second; `own` says what null is, where it may be chosen. */
export function RateField({ own, ...field }: Props<number | null> & { own?: string }) {
  const choices = own === undefined ? rates : [null, ...rates];
  return <SelectField label={words.rate} choices={choices} nameOf={(rate) => (rate === null ? (own ?? '') : String(rate))} {...field} />;
}

export function FormatField(field: Props<Format>) {
  return <SelectField label={words.format} choices={formats} nameOf={(format) => words.formats[format]} {...field} />;
}

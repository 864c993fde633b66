/** How tall somebody is, as people write it: 175, 1.75, 1,75 m, 175 cm. */

/** Metres: what the service takes. */
export const [SHORTEST, TALLEST] = [0.8, 2.4];
/** More than this is centimetres. */
const MAX_METRES = 3;

/** In metres; null where nothing is written, NaN where it is no height of a person. */
export function heightIn(text: string): number | null {
  const written = text.trim().toLowerCase();
  if (written === '') return null;
  const [, digits, unit] = /^(\d+(?:[.,]\d*)?)\s*(cm|m)?$/.exec(written) ?? [];
  if (digits === undefined) return NaN;
  const value = Number(digits.replace(',', '.'));
  const metres = unit === 'cm' || (unit === undefined && value > MAX_METRES) ? value / 100 : value;
  return metres >= SHORTEST && metres <= TALLEST ? Math.round(metres * 1000) / 1000 : NaN;
}

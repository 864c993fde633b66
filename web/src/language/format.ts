/** Numbers and dates, as the visitor's language writes them. */

import { locale, plain, strings } from './strings';

const numbers = new Map<string, Intl.NumberFormat>();

function written(value: number, options: Intl.NumberFormatOptions): string {
  const key = JSON.stringify(options);
  const known = numbers.get(key) ?? new Intl.NumberFormat(locale, options);
  numbers.set(key, known);
  return known.format(value);
}

const unit = (value: number, name: string, digits = 0): string =>
  written(value, { style: 'unit', unit: name, minimumFractionDigits: digits, maximumFractionDigits: digits });

/** `1,204`. */
export const count = (value: number): string => written(value, { maximumFractionDigits: 0 });

/** A moment in a video of this length: `3.2` in a short one, `1:07` in one of a minute or more. */
export function clock(seconds: number, length: number): string {
  const known = Math.max(0, Number.isFinite(seconds) ? seconds : 0);
  if (!(length >= 60)) return written(known, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
  return `${Math.floor(known / 60)}:${String(Math.floor(known) % 60).padStart(2, '0')}`;
}

/** A length of time as one says it: `4 sec`, `2 min`, `1 hr 20 min`. */
export function duration(seconds: number): string {
  const whole = Math.max(1, Math.ceil(seconds));
  if (whole < 60) return unit(whole, 'second');
  const minutes = Math.round(whole / 60);
  if (minutes < 60) return unit(minutes, 'minute');
  const hours = unit(Math.floor(minutes / 60), 'hour');
  return minutes % 60 === 0 ? hours : `${hours} ${unit(minutes % 60, 'minute')}`;
}

/** `0%` to `100%`; 100 only when it is done. */
export function percent(fraction: number): string {
  const whole = Math.floor(Math.min(1, Math.max(0, fraction)) * 100 + 1e-9);
  return written(whole / 100, { style: 'percent', maximumFractionDigits: 0 });
}

/** `830 kB`, `4.2 MB`: decimal units, as file managers show them. */
export function size(bytes: number): string {
  if (bytes < 1000) return unit(bytes, 'byte');
  if (bytes < 999_500) return unit(bytes / 1000, 'kilobyte');
  return bytes < 9_950_000 ? unit(bytes / 1e6, 'megabyte', 1) : unit(bytes / 1e6, 'megabyte');
}

const relative = new Intl.RelativeTimeFormat(locale, { numeric: 'auto', style: 'short' });

/** `3 min. ago`, `yesterday`. */
export function ago(moment: string, now: number = Date.now()): string {
  const seconds = (Date.parse(moment) - now) / 1000;
  if (seconds > -45) return strings.justNow;
  if (seconds > -2700) return relative.format(Math.round(seconds / 60), 'minute');
  if (seconds > -79_200) return relative.format(Math.round(seconds / 3600), 'hour');
  return relative.format(Math.round(seconds / 86_400), 'day');
}

/** `Jun 15, 2025, 12:00 PM`, in the visitor's own time zone. */
export const moment = (iso: string): string =>
  new Intl.DateTimeFormat(locale, { dateStyle: 'medium', timeStyle: 'short' }).format(new Date(iso));

/** `aunt mary.jpg` without its ending: a name that fits a heading. */
export function stem(name: string): string {
  return name.replace(/\.[A-Za-z0-9]{1,5}$/, '') || name;
}

/** What a file of the visitor's own is called: `Aunt mary`. */
export const fileTitle = (file: File): string => plain(stem(file.name));

/** Numbers in words. */

/** A moment in a video of this length: `3.2` in a short one, `1:07` in one of a minute or more. */
export function clock(seconds: number, length: number): string {
  const known = Math.max(0, Number.isFinite(seconds) ? seconds : 0);
  if (!(length >= 60)) return known.toFixed(1);
  return `${Math.floor(known / 60)}:${String(Math.floor(known) % 60).padStart(2, '0')}`;
}

/** A length of time as one says it: `4 s`, `2 min`, `1 h 20 min`. */
export function duration(seconds: number): string {
  const whole = Math.max(1, Math.ceil(seconds));
  if (whole < 60) return `${whole} s`;
  const minutes = Math.round(whole / 60);
  if (minutes < 60) return `${minutes} min`;
  return minutes % 60 === 0 ? `${minutes / 60} h` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

/** `0%` to `100%`; 100 only when it is done. */
export function percent(fraction: number): string {
  return `${Math.floor(Math.min(1, Math.max(0, fraction)) * 100 + 1e-9)}%`;
}

/** `830 kB`, `4.2 MB`: decimal units, as file managers show them. */
export function size(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 999_500) return `${Math.round(bytes / 1000)} kB`;
  return bytes < 9_950_000 ? `${(bytes / 1e6).toFixed(1)} MB` : `${Math.round(bytes / 1e6)} MB`;
}

const relative = new Intl.RelativeTimeFormat('en', { numeric: 'auto', style: 'short' });

/** `3 min. ago`, `yesterday`. */
export function ago(moment: string, now: number = Date.now()): string {
  const seconds = (Date.parse(moment) - now) / 1000;
  if (seconds > -45) return 'just now';
  if (seconds > -2700) return relative.format(Math.round(seconds / 60), 'minute');
  if (seconds > -79_200) return relative.format(Math.round(seconds / 3600), 'hour');
  return relative.format(Math.round(seconds / 86_400), 'day');
}

/** `aunt mary.jpg` without its ending: a name that fits a heading. */
export function stem(name: string): string {
  return name.replace(/\.[A-Za-z0-9]{1,5}$/, '') || name;
}

/** The document that describes a profile: docs/reactive.md, `profile.schema.json`. */

export interface StatePart {
  title: string;
  emotion: string;
  clip: string;
  frames: number;
  loops: boolean;
}

export interface TransitionPart {
  end: string;
  bridges?: string | null;
  segments: [start: number, length: number][];
  at: number[];
}

/** What sets a state off. `key` goes with `on: "key"` alone, as `KeyboardEvent.key` names it. */
export interface Trigger {
  on: 'hover' | 'click' | 'key' | 'view';
  state: string;
  key?: string | null;
}

export interface Profile {
  version: 1;
  size: [width: number, height: number];
  fps: number;
  poster: string;
  initial: string;
  states: Record<string, StatePart>;
  transitions: Record<string, TransitionPart>;
  triggers: Trigger[];
}

/** Load a profile; its address is what the names of its files are relative to. */
export async function loadProfile(address: URL, signal: AbortSignal): Promise<Profile> {
  const response = await fetch(address, { signal });
  if (!response.ok) throw new Error(`${address.href} answered ${response.status}`);
  const profile = (await response.json()) as Profile;
  if (profile.version !== 1) throw new Error(`${address.href} is no profile of version 1`);
  return profile;
}

/** The `triggers` attribute: "hover:happy click:surprise key(1):nod view:wink"; "none" leaves scripts alone. */
export function parseTriggers(text: string): Trigger[] {
  const found: Trigger[] = [];
  for (const part of text.trim().split(/\s+/)) {
    const match = /^(hover|click|view|key\((.+)\)):([\w-]+)$/.exec(part);
    if (!match) continue;
    const [, on = '', key, state = ''] = match;
    found.push(key === undefined ? { on: on as 'hover', state } : { on: 'key', key, state });
  }
  return found;
}

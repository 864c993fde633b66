/**
 * The files of a profile, each fetched whole and once: a plain file server may not serve parts of a file, which
 * jumping in a video needs.
 */
export class Files {
  private readonly fetched = new Map<string, Promise<string>>();

  constructor(
    private readonly base: URL,
    private readonly signal: AbortSignal,
  ) {}

  /** An address within the page for a file of the profile. */
  get(name: string): Promise<string> {
    let file = this.fetched.get(name);
    if (!file) {
      file = this.fetch(new URL(name, this.base));
      file.catch(() => this.fetched.delete(name)); // asked for again, it is tried again
      this.fetched.set(name, file);
    }
    return file;
  }

  /** Give the memory back. */
  release(): void {
    for (const file of this.fetched.values()) file.then(URL.revokeObjectURL, () => undefined);
    this.fetched.clear();
  }

  private async fetch(address: URL): Promise<string> {
    const response = await fetch(address, { signal: this.signal });
    if (!response.ok) throw new Error(`${address.href} answered ${response.status}`);
    const content = await response.arrayBuffer();
    this.signal.throwIfAborted();
    return URL.createObjectURL(new Blob([content], { type: 'video/mp4' }));
  }
}

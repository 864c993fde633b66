/** A picture that may be missing, or in a format that this browser does not show: then its place stays empty. */

import { useState } from 'preact/hooks';

interface Props {
  url: string | null | undefined;
  alt: string;
  lazy?: boolean;
  class?: string;
}

export function Picture({ url, alt, lazy = false, class: name }: Props) {
  const [broken, setBroken] = useState<string | null>(null);
  if (!url || broken === url) return <div class={`empty ${name ?? ''}`} aria-hidden="true" />;
  return <img class={name} src={url} alt={alt} loading={lazy ? 'lazy' : 'eager'} onError={() => setBroken(url)} />;
}

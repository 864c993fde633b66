/** A page's heading takes the focus, so that a change of page is heard as well as seen. */

import { useEffect, useRef } from 'preact/hooks';
import { strings } from '../language/strings';

interface Props {
  text: string;
  /** The page is the one that it was: the focus stays where it is. */
  still?: boolean;
}

export function Heading({ text, still = false }: Props) {
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => {
    document.title = `${text} · ${strings.name}`;
    if (!still) heading.current?.focus();
  }, [text]);
  return (
    <h1 ref={heading} tabIndex={-1}>
      {text}
    </h1>
  );
}

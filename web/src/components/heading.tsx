/** A page's heading takes the focus, so that a change of page is heard as well as seen. */

import { useEffect, useRef } from 'preact/hooks';
import { strings } from '../strings';

export function Heading({ text }: { text: string }) {
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => {
    document.title = `${text} · ${strings.name}`;
    heading.current?.focus();
  }, [text]);
  return (
    <h1 ref={heading} tabIndex={-1}>
      {text}
    </h1>
  );
}

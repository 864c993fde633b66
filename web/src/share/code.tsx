/** The request behind a result, and what embeds it, to be copied. */

import { useState } from 'preact/hooks';
import type { Job } from '../api';
import { useKind } from '../kind/kinds';
import { strings } from '../language/strings';
import { isLoopback } from './host';
import { curlOf, htmlOf, pythonOf } from './requests';
import '../styles/share.css';

const words = strings.job;

export default function CodePanel({ job }: { job: Job }) {
  const kind = useKind(job.kind);
  const key = !isLoopback(location.hostname);
  const html = htmlOf(job);
  return (
    <section class="panel share" aria-label={words.use}>
      <h2>{words.use}</h2>
      <p class="hint">{words.useHint}</p>
      <Snippet label={words.curl} code={curlOf(job, kind, location.origin, key)} />
      <Snippet label={words.python} code={pythonOf(job, kind, location.origin, key)} />
      {html && <Snippet label={words.embed} code={html} />}
    </section>
  );
}

function Snippet({ label, code }: { label: string; code: string }) {
  const [copied, setCopied] = useState(false);
  const copy = (): void =>
    void navigator.clipboard?.writeText(code).then(
      () => setCopied(true),
      () => setCopied(false), // it can be selected by hand
    );
  return (
    <div class="snippet">
      <header>
        <h3>{label}</h3>
        {navigator.clipboard && (
          <button type="button" class="toggle" aria-label={`${strings.copy}: ${label}`} onClick={copy}>
            {copied ? strings.copied : strings.copy}
          </button>
        )}
      </header>
      <pre tabIndex={0}>
        <code>{code}</code>
      </pre>
    </div>
  );
}

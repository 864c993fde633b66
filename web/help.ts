/** The documentation as pages beside the page, under `help/`: whoever runs the service has it without a network. */

import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { Marked } from 'marked';
import type { Plugin } from 'vite';

/** What the pages are called in the list beside each of them, in this order; the others are led to from these. */
const MENU = {
  page: 'Using the page',
  index: 'Quick start',
  portrait: 'Portraits',
  characters: 'Characters',
  reactive: 'Interactive portraits',
  limits: 'Limits',
  rest: 'REST API',
  'python-client': 'Python client',
  webhooks: 'Webhooks',
  'operations/guide': 'Operation',
  settings: 'Settings',
  'responsible-use': 'Responsible use',
  licences: 'Licences',
};

export function help(folder: string): Plugin {
  return {
    name: 'help',
    apply: 'build',
    generateBundle() {
      for (const path of readdirSync(folder, { recursive: true, encoding: 'utf8' })) {
        const source = join(folder, path);
        if (!path.endsWith('.md')) {
          if (statSync(source).isFile()) this.emitFile({ type: 'asset', fileName: `help/${path}`, source: readFileSync(source) });
          continue;
        }
        const name = path.slice(0, -'.md'.length);
        this.emitFile({ type: 'asset', fileName: `help/${name}.html`, source: page(name, readFileSync(source, 'utf8')) });
      }
    },
  };
}

function page(name: string, text: string): string {
  const up = '../'.repeat(name.split('/').length - 1);
  const title = /^# (.+)$/m.exec(text)?.[1] ?? name;
  const menu = Object.entries(MENU)
    .map(([to, word]) => `<li><a href="${up}${to}.html"${to === name ? ' aria-current="page"' : ''}>${word}</a></li>`)
    .join('\n');
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" type="image/svg+xml" href="/favicon.svg">
<link rel="stylesheet" href="/help.css">
<title>${escaped(title)} · Galatea</title>
</head>
<body>
<header>
<a class="mark" href="/"><img src="/favicon.svg" width="28" height="28" alt="">Galatea</a>
<a class="topics" href="#topics">All topics</a>
<a href="/">Back to the page</a>
</header>
<main>${rendered(text, up)}</main>
<nav id="topics" aria-label="Help"><ul>${menu}</ul></nav>
</body>
</html>
`;
}

const escaped = (text: string): string => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/"/g, '&quot;');

/** Headings can be linked to, links between documents lead from page to page, and wide tables scroll by themselves. */
function rendered(text: string, up: string): string {
  const marked = new Marked({
    renderer: {
      heading({ tokens, depth, text: heading }) {
        return `<h${depth} id="${slug(heading)}">${this.parser.parseInline(tokens)}</h${depth}>\n`;
      },
      link({ href, tokens }) {
        // a file of the project that is no page here, such as the changelog
        if (href.startsWith(`${up}../`)) return this.parser.parseInline(tokens);
        const to = /^[a-z]+:/.test(href) ? href : href.replace(/\.md(?=#|$)/, '.html');
        return `<a href="${escaped(to)}">${this.parser.parseInline(tokens)}</a>`;
      },
    },
  });
  // `:` blocks of the other renderer's attributes are of no use here
  const html = marked.parse(text.replace(/\{:? ?[#.][^}\n]*\}/g, ''), { async: false });
  return html.replace(/<pre>/g, '<pre tabindex="0">').replace(/<table>/g, '<div class="wide" tabindex="0"><table>').replace(/<\/table>/g, '</table></div>');
}

/** As the documentation's other renderer makes them, so that links to a heading fit both. */
const slug = (heading: string): string =>
  heading
    .toLowerCase()
    .replace(/[^\w\s-]/g, '')
    .trim()
    .replace(/[\s-]+/g, '-');

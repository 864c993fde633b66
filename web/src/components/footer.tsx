/** At the end of every page: where help is. The service has these pages itself; none of them is elsewhere. */

import { strings } from '../strings';

const words = strings.footer;
const links = [
  { to: '/help/index.html', text: words.help },
  { to: '/help/rest.html', text: words.api },
  { to: '/v1/openapi.json', text: words.openapi },
  { to: '/help/responsible-use.html', text: words.use },
  { to: '/help/licences.html', text: words.licences },
];

export function Footer() {
  return (
    <footer class="colophon">
      <nav aria-label={words.label}>
        {links.map(({ to, text }) => (
          <a key={to} href={to}>
            {text}
          </a>
        ))}
      </nav>
    </footer>
  );
}

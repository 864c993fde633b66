/** At the end of every page: where help is. The service has these pages itself; none of them is elsewhere. */

import { strings } from '../language/strings';

const words = strings.footer;
const links = [
  { to: '/help/page.html', text: words.help, own: true },
  { to: '/help/rest.html', text: words.api, own: true },
  { to: '/v1/openapi.json', text: words.openapi, own: true },
  { to: '/help/responsible-use.html', text: words.use, own: false },
  { to: '/help/licences.html', text: words.licences, own: false },
];

/** `guest`: of somebody who was sent a link, and has nothing to do with the service. */
export function Footer({ guest }: { guest: boolean }) {
  return (
    <footer class="site-footer">
      <nav aria-label={words.label}>
        {links.filter(({ own }) => !own || !guest).map(({ to, text }) => (
          <a key={to} href={to}>
            {text}
          </a>
        ))}
      </nav>
    </footer>
  );
}

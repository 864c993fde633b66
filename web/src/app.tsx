/** The page around the pages: where one is, and where one can go. */

import { useEffect, useState } from 'preact/hooks';
import { KindsProvider } from './kind/kinds';
import { kinds } from './kinds';
import { Footer } from './widgets/footer';
import { later, part } from './widgets/lazy';
import { DraftsProvider } from './studio/draft';
import { OfferedKindsProvider } from './kind/offered';
import { HistoryPage } from './pages/history';
import { JobPage } from './pages/job';
import { LostPage } from './pages/lost';
import { SignInPage } from './pages/signin';
import { historyLink, keysLink, type Route, studioLink, useRoute, webhooksLink } from './route';
import { onLocked } from './api/session';
import { strings } from './language/strings';

const SharedPage = later(() => import('./pages/shared'));
const LivePage = later(() => import('./pages/live'));
const KeysPage = later(() => import('./pages/keys'));
const WebhooksPage = later(() => import('./pages/webhooks'));

export function App() {
  const route = useRoute(kinds.all);
  const [locked, setLocked] = useState(false);
  useEffect(() => onLocked(() => setLocked(true)), []);
  if (route.page === 'live') return <LivePage key={route.id} id={route.id} token={route.token} />;
  const shared = route.page === 'shared';
  return (
    <KindsProvider value={kinds}>
      <a class="skip" href="#content" onClick={skipToContent}>
        {strings.skip}
      </a>
      <header class="masthead">
        <a class="wordmark" href={studioLink} aria-label={strings.home}>
          <img src="/favicon.svg" alt="" width="28" height="28" />
          <span>{strings.name}</span>
        </a>
        {!shared && !locked && <Navigation page={route.page} />}
      </header>
      <main id="content" tabIndex={-1}>
        {locked && !shared ? (
          <SignInPage onOpen={() => setLocked(false)} />
        ) : (
          <OfferedKindsProvider guest={shared}>
            <DraftsProvider>
              <Page route={route} />
            </DraftsProvider>
          </OfferedKindsProvider>
        )}
      </main>
      <Footer guest={shared} />
    </KindsProvider>
  );
}

function Navigation({ page }: { page: Route['page'] }) {
  const words = strings.navigation;
  const places = [
    { page: 'history', link: historyLink(null), text: words.history },
    { page: 'keys', link: keysLink, text: words.keys },
    { page: 'webhooks', link: webhooksLink, text: words.webhooks },
  ] as const;
  return (
    <nav aria-label={words.label}>
      {places.map(({ page: one, link, text }) => (
        <a key={one} href={link} aria-current={one === page ? 'page' : undefined}>
          {text}
        </a>
      ))}
    </nav>
  );
}

function Page({ route }: { route: Exclude<Route, { page: 'live' }> }) {
  switch (route.page) {
    case 'studio': {
      const kind = kinds.of(route.kind);
      const Studio = part(kind.loadStudio);
      return <Studio key={kind.name} kind={kind} />;
    }
    case 'job':
      return <JobPage key={route.id} id={route.id} />;
    case 'history':
      return <HistoryPage status={route.status} words={route.words} />;
    case 'shared':
      return <SharedPage key={route.token} token={route.token} />;
    case 'keys':
      return <KeysPage />;
    case 'webhooks':
      return <WebhooksPage />;
    case 'lost':
      return <LostPage />;
  }
}

/** The part after `#` is the route here, so the jump is made by hand. */
function skipToContent(event: Event): void {
  event.preventDefault();
  document.getElementById('content')?.focus();
}

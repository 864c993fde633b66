import './styles/tokens.css';
import './styles/base.css';
import './styles/controls.css';
import './styles/layout.css';
import './styles/studio.css';
import './styles/job.css';
import { render } from 'preact';
import { JobPage } from './pages/job';
import { StudioPage } from './pages/studio';
import { studioLink, useRoute } from './route';
import { strings } from './strings';

function App() {
  const route = useRoute();
  return (
    <>
      <a class="skip" href="#content" onClick={skipToContent}>
        {strings.skip}
      </a>
      <header class="masthead">
        <a class="wordmark" href={studioLink} aria-label={strings.home}>
          <img src="/favicon.svg" alt="" width="28" height="28" />
          <span>{strings.name}</span>
        </a>
      </header>
      <main id="content" tabIndex={-1}>
        {route.page === 'job' ? <JobPage key={route.id} id={route.id} /> : <StudioPage />}
      </main>
    </>
  );
}

/** The part after `#` is the route here, so the jump is made by hand. */
function skipToContent(event: Event): void {
  event.preventDefault();
  document.getElementById('content')?.focus();
}

const root = document.getElementById('app');
if (root) render(<App />, root);

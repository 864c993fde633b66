import './styles/tokens.css';
import './styles/base.css';
import './styles/controls.css';
import './styles/layout.css';
import './styles/studio.css';
import './styles/job.css';
import { render } from 'preact';
import { App } from './app';
import { kinds } from './kinds';
import { parseRoute } from './route';
import { language } from './language/strings';
import { preload } from './widgets/lazy';

document.documentElement.lang = language;
const root = document.getElementById('app');
const show = (): void => {
  if (root) render(<App />, root);
};
const route = parseRoute(kinds.all, location.hash, location.pathname);
// a studio comes with the page around it, not after it; where it does not come, the page says so
if (route.page === 'studio') preload(kinds.of(route.kind).loadStudio).then(show, show);
else show();

import './styles/tokens.css';
import './styles/base.css';
import './styles/controls.css';
import './styles/layout.css';
import './styles/studio.css';
import './styles/job.css';
import { render } from 'preact';
import { App } from './app';
import { language } from './strings';

document.documentElement.lang = language;
const root = document.getElementById('app');
if (root) render(<App />, root);

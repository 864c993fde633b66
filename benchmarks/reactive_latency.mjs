// How soon a reactive profile reacts: from a call of `play` to the first frame of what leads away being drawn.
//
//   node benchmarks/reactive_latency.mjs FOLDER [TRIGGERS]     FOLDER is an unzipped profile.zip

import { once } from 'node:events';
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { cpus } from 'node:os';
import { extname, join } from 'node:path';
import { chromium } from '../web/node_modules/playwright-core/index.mjs';

const [folder, triggers = '40'] = process.argv.slice(2);
if (!folder) throw new Error('usage: node benchmarks/reactive_latency.mjs FOLDER [TRIGGERS]');
const types = { '.html': 'text/html', '.js': 'text/javascript', '.json': 'application/json', '.jpg': 'image/jpeg', '.mp4': 'video/mp4' };
const server = createServer(async ({ url }, response) => {
  const name = url === '/' ? 'index.html' : url.slice(1).replaceAll('..', '');
  try {
    const content = await readFile(join(folder, name));
    response.setHeader('Content-Type', types[extname(name)] ?? 'application/octet-stream').end(content);
  } catch {
    response.writeHead(404).end();
  }
}).listen(0, '127.0.0.1');
await once(server, 'listening');

const browser = await chromium.launch({
  executablePath: process.env.GALATEA_CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu'],
});
const page = await browser.newPage({ viewport: { width: 1000, height: 800 } });
await page.goto(`http://127.0.0.1:${server.address().port}/`);
const measured = await page.evaluate(async (count) => {
  const portrait = document.querySelector('reactive-portrait');
  const { states, initial } = await (await fetch('profile.json')).json();
  const names = Object.keys(states);
  const files = () => performance.getEntriesByType('resource').filter(({ name }) => name.endsWith('.mp4')).length;
  const pause = (ms) => new Promise((wake) => setTimeout(wake, ms));
  while (files() < 2 * names.length) await pause(100);
  await pause(1000);
  const found = { reaction: [], clip: [] };
  for (let turn = 0; turn < count; turn++) {
    const state = names.filter((name) => name !== portrait.state)[turn % (names.length - 1)];
    const began = performance.now();
    portrait.play(state);
    await new Promise((done) => {
      let first = true;
      portrait.onframe = (shown) => {
        if (first) found.reaction.push(performance.now() - began);
        first = false;
        if (shown.state !== state || shown.part !== 'clip') return;
        found.clip.push(performance.now() - began);
        portrait.onframe = null;
        done();
      };
    });
    await pause(400 + ((turn * 631) % 2500)); // from all over the clips, the idle one included
    if (portrait.state !== initial && turn % 2) while (portrait.state !== initial) await pause(50);
  }
  return found;
}, Number(triggers));
const row = (name, values) => {
  const sorted = values.toSorted((a, b) => a - b);
  const at = (share) => Math.round(sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))]);
  console.log(`| ${name} | ${at(0.5)} ms | ${at(0.95)} ms | ${at(1)} ms |`);
};
console.log(`${triggers} triggers, ${cpus().length} x ${cpus()[0].model}, Chromium ${browser.version()} without a GPU\n`);
console.log('| from the trigger to | median | 95 % | worst |\n| --- | --- | --- | --- |');
row('the first frame that leads away', measured.reaction);
row("the first frame of the state's clip", measured.clip);
await browser.close();
server.close();

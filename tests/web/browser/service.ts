/** Starts a real `galatea serve` on a free port, with a data folder of its own: forked from what has imported the program. */

import { type ChildProcess, execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, openSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

export const root = resolve(import.meta.dirname, '../../..');

/** The variable of the environment that names the socket of `warm_server`, for all processes of the tests. */
export const SOCKET = 'GALATEA_TESTS_WARM';

export interface Service {
  address: string;
  /** Its data folder. */
  data: string;
  /** Ends it; its folder stays. */
  stop: () => Promise<void>;
  /** Ends it, and its folder with it. */
  end: () => Promise<void>;
}

/** Settings of all services that a file of tests starts. */
export const shared: Record<string, string> = {};

/** A service of its own, with these settings besides; its data folder is empty, or a copy of one that a service has left. */
export async function serve(settings: Record<string, string> = {}, left?: string): Promise<Service> {
  const folder = mkdtempSync(join(tmpdir(), 'galatea-web-'));
  const [data, log] = [join(folder, 'data'), join(folder, 'serve.log')];
  // with the owners of the files, who are others where root tests
  if (left !== undefined) execFileSync('cp', ['--archive', left, data]);
  const output = openSync(log, 'w');
  const started = ['-P', join(root, 'tests/live_service/warm_start.py'), process.env[SOCKET] ?? ''];
  const service = spawn(
    'setpriv', // it ends with this process, however that ends
    ['--pdeathsig', 'TERM', join(root, '.venv/bin/python'), ...started, 'serve', '--port', '0'],
    {
      cwd: root,
      // whoever waits for a job has no less of the machine than other tests
      env: { ...process.env, GALATEA_DATA_DIR: data, GALATEA_ALLOWED_NETWORKS: '127.0.0.0/8', GALATEA_JOB_NICENESS: '0', ...shared, ...settings },
      stdio: ['ignore', output, output],
    },
  );
  const stop = (): Promise<void> => stopped(service);
  const end = async (): Promise<void> => {
    await stop();
    rmSync(folder, { recursive: true, force: true });
  };
  let address: string;
  try {
    address = await untilReady(service, log);
  } catch (error) {
    await end();
    throw error;
  }
  return { address, data, stop, end };
}

/** Where it serves, once all that it needs is there. */
async function untilReady(service: ChildProcess, log: string): Promise<string> {
  const deadline = Date.now() + 300_000;
  while (Date.now() < deadline && service.exitCode === null) {
    const address = /^Galatea serves at (http:.*)\/$/m.exec(readFileSync(log, 'utf8'))?.[1];
    if (address && (await fetch(`${address}/readyz`).then(({ ok }) => ok, () => false))) return address;
    await new Promise((wake) => setTimeout(wake, 50));
  }
  throw new Error(`galatea serve did not become ready:\n${readFileSync(log, 'utf8')}`);
}

function stopped(service: ChildProcess): Promise<void> {
  if (service.exitCode !== null || service.signalCode !== null) return Promise.resolve();
  return new Promise((done) => {
    service.once('exit', () => done());
    service.kill('SIGTERM');
  });
}

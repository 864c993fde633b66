/** Starts a real `galatea serve` on a free port with an empty data folder, for all browser tests of a run. */

import { type ChildProcess, spawn } from 'node:child_process';
import { mkdtempSync, openSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import type { TestProject } from 'vitest/node';

declare module 'vitest' {
  export interface ProvidedContext {
    address: string;
  }
}

const root = resolve(import.meta.dirname, '../../..');

export default async function setup(project: TestProject): Promise<() => Promise<void>> {
  const { address, end } = await serve();
  project.provide('address', address);
  return end;
}

/** A service of its own, with these settings besides; and what ends it. */
export async function serve(settings: Record<string, string> = {}): Promise<{ address: string; end: () => Promise<void> }> {
  const data = mkdtempSync(join(tmpdir(), 'galatea-web-'));
  const log = join(data, 'serve.log');
  const address = `http://127.0.0.1:${await freePort()}`;
  const output = openSync(log, 'w');
  const service = spawn(
    join(root, '.venv/bin/python'),
    ['-m', 'shell.main', 'serve', '--host', '127.0.0.1', '--port', new URL(address).port],
    {
      cwd: root,
      env: { ...process.env, GALATEA_DATA_DIR: join(data, 'data'), GALATEA_ALLOWED_NETWORKS: '127.0.0.0/8', ...settings },
      stdio: ['ignore', output, output],
    },
  );
  try {
    await untilReady(service, address, log);
  } catch (error) {
    await stop(service);
    throw error;
  }
  const end = async (): Promise<void> => {
    await stop(service);
    rmSync(data, { recursive: true, force: true });
  };
  return { address, end };
}

async function untilReady(service: ChildProcess, address: string, log: string): Promise<void> {
  const deadline = Date.now() + 120_000;
  while (Date.now() < deadline && service.exitCode === null) {
    try {
      if ((await fetch(`${address}/readyz`)).ok) return;
    } catch {
      // not listening yet
    }
    await new Promise((wake) => setTimeout(wake, 200));
  }
  throw new Error(`galatea serve did not become ready:\n${readFileSync(log, 'utf8')}`);
}

function stop(service: ChildProcess): Promise<void> {
  if (service.exitCode !== null) return Promise.resolve();
  return new Promise((done) => {
    service.once('exit', () => done());
    service.kill('SIGTERM');
  });
}

function freePort(): Promise<number> {
  return new Promise((found, failed) => {
    const probe = createServer();
    probe.once('error', failed);
    probe.listen(0, '127.0.0.1', () => {
      const address = probe.address();
      probe.close(() => (address && typeof address === 'object' ? found(address.port) : failed(new Error('no port'))));
    });
  });
}

/** What the services of the tests are forked from (`tests/live_service/warm_server.py`): each begins with the program imported. */

import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { root, SOCKET } from './service';

export default async function setup(): Promise<() => void> {
  const folder = mkdtempSync(join(tmpdir(), 'galatea-warm-'));
  const socket = join(folder, 'socket');
  const server = spawn(join(root, '.venv/bin/python'), ['-P', join(root, 'tests/live_service/warm_server.py'), socket], {
    env: { ...process.env, PYTHONPATH: root, OPENBLAS_NUM_THREADS: '1' }, // whose threads could not be forked
    stdio: ['ignore', 'inherit', 'inherit'],
  });
  while (!existsSync(socket)) {
    if (server.exitCode !== null) throw new Error('what services are forked from did not start');
    await new Promise((wake) => setTimeout(wake, 20));
  }
  process.env[SOCKET] = socket;
  return () => {
    server.kill();
    rmSync(folder, { recursive: true, force: true });
  };
}

import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

// The tests stand in ../tests/web; what they import by name is installed here.
const here = (path: string): string => fileURLToPath(new URL(path, import.meta.url));
const installed = (name: string): [string, string] => [name, here(`node_modules/${name}`)];
const alias = { ...Object.fromEntries(['playwright-core', 'standardwebhooks', 'three', 'typescript', 'vite'].map(installed)), '@web': here('src') };
const root = here('../tests/web');

export default defineConfig({
  test: {
    projects: [
      { resolve: { alias }, test: { name: 'unit', root, include: ['unit/**/*.test.ts'], testTimeout: 60_000 } },
      {
        resolve: { alias },
        test: {
          name: 'browser',
          root,
          include: ['browser/**/*.test.ts'],
          globalSetup: ['browser/warm_server.ts', 'browser/finished_jobs.ts', 'browser/viewer_build.ts'],
          testTimeout: 1_500_000,
          expect: { poll: { timeout: 300_000 } },
          hookTimeout: 900_000,
          maxWorkers: 2, // each file has a browser and a service of its own: see browser/own_service.ts
        },
      },
    ],
  },
});

import './nobody_works';
import { readFileSync } from 'node:fs';
import { expect, it } from 'vitest';
import { address } from './own_service';
import { clientTypes } from '../../../web/client.mjs';

it('speaks of the service as the service describes itself (`npm run client` where it does not)', async () => {
  const described = (await (await fetch(`${address}/v1/openapi.json`)).json()) as object;
  const kept = readFileSync(new URL('../../../web/src/api/openapi.ts', import.meta.url), 'utf8');
  expect(kept).toBe(await clientTypes(described));
});

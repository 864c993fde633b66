// The types of the HTTP client, drawn from the service's OpenAPI document: `npm run client` writes src/api/openapi.ts.

import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import openapiTS, { astToString } from 'openapi-typescript';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const HEADING = '/** Drawn from the OpenAPI document of the service by `npm run client`: not to be edited. */\n\n';

/** The TypeScript that describes a document's paths and schemas. */
export async function clientTypes(document) {
  // pydantic gives every property a title that says its name once more
  const untitled = JSON.parse(JSON.stringify(document), function (key, value) {
    return key === 'title' && typeof value === 'string' && !('version' in this) ? undefined : value;
  });
  // what has a default may be left out of a request, so that a new option of the service breaks no client
  return HEADING + astToString(await openapiTS(untitled, { defaultNonNullable: false }));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const printed = execFileSync(here('../.venv/bin/python'), ['-m', 'scripts.openapi'], {
    cwd: here('..'),
    maxBuffer: 64e6,
  });
  writeFileSync(here('src/api/openapi.ts'), await clientTypes(JSON.parse(printed.toString())));
}

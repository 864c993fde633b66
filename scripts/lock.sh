#!/usr/bin/env bash
# Resolves the dependencies anew. Neither lock holds an address: packages come from whatever index the user has set.
set -euo pipefail
cd "$(dirname "$0")/.."

command -v uv >/dev/null || { echo "lock: needs uv (pip install uv)" >&2; exit 1; }
uv pip compile --quiet --universal --generate-hashes --no-emit-index-url --extra dev pyproject.toml -o requirements.lock

cd web
npm update --package-lock-only --loglevel=error
node --input-type=module - <<'SCRIPT'
import { readFileSync, writeFileSync } from 'node:fs';
const lock = JSON.parse(readFileSync('package-lock.json', 'utf8'));
for (const entry of Object.values(lock.packages)) {
  delete entry.resolved;
  delete entry.funding;
}
writeFileSync('package-lock.json', JSON.stringify(lock, null, 2) + '\n');
SCRIPT

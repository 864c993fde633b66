#!/usr/bin/env bash
# Resolves the dependencies anew. Neither lock holds an address: packages come from whatever index the user has set.
set -euo pipefail
cd "$(dirname "$0")/.."

command -v uv >/dev/null || { echo "lock: needs uv (pip install uv)" >&2; exit 1; }
# Versions stay as they are locked, unless pyproject.toml asks for others.
compile() { uv pip compile --quiet --universal --generate-hashes --no-emit-index-url --no-annotate --no-header pyproject.toml "$@"; }
compile -o requirements.lock
# What tests and documents need beside it: the packages that are locked with them and not without.
whole=$(mktemp)
trap 'rm -f "$whole"' EXIT
cat requirements.lock requirements-dev.lock > "$whole"
compile --extra dev -c requirements.lock -o "$whole"
awk '/^[^ ]/ { own = !($0 in there) } FNR == NR { there[$0]; next } own' requirements.lock "$whole" > requirements-dev.lock

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

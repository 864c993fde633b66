#!/usr/bin/env bash
# Runs every check of the project and sums up at the end: each check runs even if an earlier one failed. Checks run beside
# one another where that leaves no core idle: browser tests wait half of their time, and what is compiled ends on one core.
set -uo pipefail
cd "$(dirname "$0")/.."

[ -t 1 ] || export NO_COLOR=1
reports=var/test-reports
failed=()
declare -A begun
rm -rf "$reports"
mkdir -p "$reports"
trap 'for group in "${begun[@]}"; do kill -- "-$group"; done 2>/dev/null' EXIT

heading() { printf '\n\033[1m== %s ==\033[0m\n' "$1"; }
# begin CHECK: beside what else runs; what it prints is kept until `finish CHECK` waits for its end.
begin() { setsid make --no-print-directory "$1" >"$reports/$1.log" 2>&1 & begun[$1]=$!; }
finish() { heading "$1"; wait "${begun[$1]}" || failed+=("$1"); cat "$reports/$1.log"; }

for check in compiled lint types imports web-unit; do begin "$check"; done
finish compiled
begin web-browser  # ends last: it waits longest
for check in lint types imports web-unit; do finish "$check"; done
heading unit
make --no-print-directory --old-file=compiled unit || failed+=(unit)
finish web-browser

printf '\n'
.venv/bin/python scripts/tally.py "$reports"/*.xml || failed+=(tally)
if [ ${#failed[@]} -gt 0 ]; then
  printf 'failed checks: %s\n' "${failed[*]}" >&2
  exit 1
fi

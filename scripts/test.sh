#!/usr/bin/env bash
# Runs every check of the project and sums up at the end: each check runs even if an earlier one failed.
set -uo pipefail
cd "$(dirname "$0")/.."

[ -t 1 ] || export NO_COLOR=1
failed=()
rm -rf var/test-reports
make --no-print-directory compiled &  # beside checks that have one core enough
for check in lint types imports web-unit unit web-browser; do
  [ "$check" = unit ] && wait
  printf '\n\033[1m== %s ==\033[0m\n' "$check"
  make --no-print-directory "$check" || failed+=("$check")
done

printf '\n'
.venv/bin/python scripts/tally.py var/test-reports/*.xml || failed+=(tally)
if [ ${#failed[@]} -gt 0 ]; then
  printf 'failed checks: %s\n' "${failed[*]}" >&2
  exit 1
fi

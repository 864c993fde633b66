#!/usr/bin/env bash
# Builds docs/ into site/. Warnings, such as links that lead nowhere, are errors.
set -euo pipefail
cd "$(dirname "$0")/.."
NO_MKDOCS_2_WARNING=1 DISABLE_MKDOCS_2_WARNING=true .venv/bin/python -m mkdocs build --strict --quiet "$@"

#!/usr/bin/env bash
# Installs Galatea into this checkout: .venv/ from requirements.lock, web/dist/ from web/package-lock.json. With
# --for-tests also requirements-dev.lock and what tests need of Debian; with --for-s3-trial what `make s3-trial` does.
# Runs again at no cost: each step is skipped while the files that it depends on are unchanged.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { printf '\033[1m%s\033[0m\n' "$*" >&2; }
fail() { printf 'setup: %s\n' "$*" >&2; exit 1; }

# install_debian PACKAGE...: by apt-get, as root or through sudo; says what to type where neither is possible.
install_debian() {
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || fail "please run as root: apt-get install $*"
    as_root=(sudo)
  fi
  command -v apt-get >/dev/null || fail "this machine has no apt-get: please install $* (or its equal) by hand"
  say "Installing $* (apt-get)"
  "${as_root[@]}" apt-get update -qq || true
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq -o Dpkg::Use-Pty=0 --no-install-recommends "$@" >/dev/null ||
    fail "apt-get could not install $*"
}

find_python() {
  local candidate
  for candidate in "${PYTHON:-}" python3.11 python3.12 python3; do
    if [ -n "$candidate" ] && "$candidate" -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 13))' 2>/dev/null
    then echo "$candidate"; return; fi
  done
  fail "needs Python 3.11 or 3.12 (set PYTHON=... if it stands elsewhere)"
}

create_environment() {
  local python; python=$(find_python)
  if ! "$python" -c 'import venv, ensurepip' 2>/dev/null; then  # Debian keeps both in a package of their own
    install_debian "python$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')-venv"
  fi
  say "Creating .venv with $("$python" --version)"
  "$python" -m venv .venv
}

# unchanged STAMP KEY: whether the step was last done for the same key.
unchanged() { [ -f "$1" ] && [ "$(cat "$1")" = "$2" ]; }
fingerprint() { cat "$@" | sha256sum | cut -d' ' -f1; }

# install_python LOCK...: the packages of these locks, and the project itself.
install_python() {
  local stamp=.venv/.installed key lock
  [ -x .venv/bin/python ] || create_environment
  key=$(.venv/bin/python --version | cat - "$@" pyproject.toml | sha256sum | cut -d' ' -f1)
  unchanged "$stamp" "$key" && [ -x .venv/bin/galatea ] && return
  local pip=(.venv/bin/python -m pip --disable-pip-version-check)
  [ -t 1 ] || pip+=(--quiet --quiet)
  for lock in "$@"; do
    say "Installing the packages of $lock"
    "${pip[@]}" install --no-deps --require-hashes -r "$lock"
  done
  "${pip[@]}" install --no-deps --no-build-isolation --editable .
  echo "$key" > "$stamp"
}

check_node() {
  command -v node >/dev/null && command -v npm >/dev/null || fail "needs Node 20.19 or later with npm"
  node -e 'const [a, b] = process.versions.node.split(".").map(Number);
    process.exit(a > 22 || (a === 22 && b >= 12) || (a === 20 && b >= 19) ? 0 : 1)' ||
    fail "needs Node 20.19 or later, or 22.12 or later; this is $(node --version)"
}

build_web() {
  local packages sources
  packages=$(fingerprint web/package.json web/package-lock.json web/.npmrc)
  if ! unchanged web/node_modules/.installed "$packages"; then
    say "Installing web packages"
    (cd web && npm ci --no-progress --loglevel=error)
    echo "$packages" > web/node_modules/.installed
  fi
  sources=$(find web/src web/public web/index.html web/*.ts web/*.json docs -type f | LC_ALL=C sort | xargs sha256sum | sha256sum)
  if ! unchanged web/dist/.built "$sources"; then
    say "Building web/dist"
    (cd web && npm run --silent build -- --logLevel warn)
    echo "$sources" > web/dist/.built
  fi
}

# The web component that plays reactive profiles: npm's package, the service's page and every profile's bundle have it.
build_player() {
  local sources script=web/reactive/dist/reactive-portrait.js copy
  sources=$(find web/reactive web/package.json -type f -not -path '*/dist/*' | LC_ALL=C sort | xargs sha256sum | sha256sum)
  if ! unchanged web/reactive/dist/.built "$sources"; then
    say "Building the player of reactive profiles"
    (cd web && npm run --silent build:reactive -- --logLevel warn)
    echo "$sources" > web/reactive/dist/.built
  fi
  for copy in web/dist engine/portrait/reactive/player; do
    mkdir -p "$copy"
    cmp -s "$script" "$copy/${script##*/}" || cp "$script" "$copy/"
  done
  node web/compress.mjs web/dist
}

# What only the tests need: a browser that is driven without a window, PostgreSQL, what makes networks, OpenGL
# without a screen, and what the guide's commands use.
install_test_tools() {
  compgen -G '/usr/lib/postgresql/*/bin/initdb' >/dev/null || command -v initdb >/dev/null || install_debian postgresql
  command -v ip >/dev/null || install_debian iproute2
  command -v nsenter >/dev/null && command -v setpriv >/dev/null || install_debian util-linux
  command -v curl >/dev/null && command -v jq >/dev/null || install_debian curl jq
  .venv/bin/python -c 'import ctypes; ctypes.CDLL("libEGL_mesa.so.0")' 2>/dev/null ||
    install_debian libegl1 libgl1 libgl1-mesa-dri
  [ -n "${GALATEA_CHROMIUM:-}" ] || command -v chromium >/dev/null || install_debian chromium fonts-dejavu-core
}

# A real S3 server. Debian starts what it installs: memcached is then a service of the machine (on loopback); Swift's
# stores have no rings and do not start. The trial uses neither, it starts its own.
install_s3_server() {
  command -v memcached >/dev/null || install_debian memcached
  command -v swift-proxy-server >/dev/null && command -v swift-object-server >/dev/null ||
    install_debian swift-proxy swift-account swift-container swift-object
}

locks=(requirements.lock)
# What is installed for tests is kept up to date by whoever runs the demo next: one environment serves both.
if [ "${1:-}" = --for-tests ] || [ -x .venv/bin/pytest ]; then locks+=(requirements-dev.lock); fi
# Each computes on one core for most of its time: both together take as long as the longer one.
check_node
(build_web; build_player) & page=$!
install_python "${locks[@]}"
.venv/bin/python -m scripts.model_files
wait "$page"
if [ "${1:-}" = --for-tests ]; then install_test_tools; fi
if [ "${1:-}" = --for-s3-trial ]; then install_s3_server; fi

# The two commands: `make demo` shows it, `make test` checks it. Both install what they need first.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
BIN := .venv/bin
REPORTS := var/test-reports

.PHONY: help setup tools demo test lint types imports compiled unit coverage s3-trial web-test web-unit web-browser client lock bench picture pictures samples docs licences wheel clean

help:  ## this list
	@grep -hE '^[a-z0-9-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z0-9-]+):[^#]*## /\1\t/' | expand -t 14

setup:  ## install into .venv/, build web/dist/ and the player of reactive profiles
	@scripts/setup.sh

tools:  ## what tests, documents and benchmarks need beside it, too
	@scripts/setup.sh --for-tests

demo: setup  ## a portrait brought to life through the HTTP API; ONCE=1, IMAGE=..., DRIVER=...
	@$(BIN)/python scripts/demo.py $(if $(IMAGE),--image "$(IMAGE)") $(if $(DRIVER),--driver "$(DRIVER)") $(if $(ONCE),--once)

test: tools  ## every check, each even if an earlier one failed
	@scripts/test.sh

lint:  ## ruff: lint and format
	@failed=0; $(BIN)/ruff check . || failed=1; $(BIN)/ruff format --check . || failed=1; exit $$failed

types:  ## mypy strict on all Python that runs, tsc strict on the page
	@failed=0; $(BIN)/mypy || failed=1; (cd web && npm run --silent types) || failed=1; exit $$failed

imports:  ## which package may import which
	@$(BIN)/lint-imports

# Tests of the service wait for processes half of their time: three of them keep two cores at work. What computes has one
# thread for its algebra then, since threads of one that wait for each other in turns would take it from the others. In
# the order of their folders the last files are short ones: nobody works alone at the end.
PYTEST := OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $(BIN)/pytest --numprocesses 3 --dist loadfile --no-loadscope-reorder --disable-warnings

# Once for all three, which would compile the same at the same time. Python's own, too: where the environment forbids to
# write it by the way (PYTHONDONTWRITEBYTECODE), each of some hundred services would compile itself anew, and each of the
# three all tests, whose assertions pytest rewrites first; again once a test or pytest is newer. What cannot be collected is told
# where tests are run.
COLLECTED := .pytest_cache/collected
compiled:
	@$(BIN)/python -m compileall -q engine galatea galatea_client service shell worker tests
	@if [ ! -e $(COLLECTED) ] || [ -n "$$(find tests $(BIN)/pytest \( -name '*.py' -o -name pytest \) -newer $(COLLECTED) -print -quit)" ]; then \
	  PYTHONDONTWRITEBYTECODE= $(BIN)/pytest --collect-only >/dev/null || true; mkdir -p $(dir $(COLLECTED)); touch $(COLLECTED); fi
	@$(BIN)/python -m scripts.compiled

unit: compiled  ## pytest: engine, service, worker, shell
	@mkdir -p $(REPORTS)
	@$(PYTEST) --junitxml=$(REPORTS)/python.xml

coverage: compiled  ## the same, and then which lines none of them reached
	@failed=0; $(PYTEST) --cov --cov-report= || failed=1; $(BIN)/coverage report --show-missing; exit $$failed

web-test: web-unit web-browser  ## the page: its parts, and the whole in a browser against a running service

web-unit:
	@cd web && npm run --silent unit -- --reporter=dot --reporter=junit --outputFile=../$(REPORTS)/web-unit.xml

web-browser:
	@cd web && npm run --silent browser -- --reporter=dot --reporter=junit --outputFile=../$(REPORTS)/web-browser.xml

s3-trial: tools  ## the tests of the storage once more, against a real server of another make (OpenStack Swift)
	@scripts/setup.sh --for-s3-trial
	@GALATEA_TESTS_S3=swift $(BIN)/pytest -s $(addprefix tests/,service/storage/test_storage.py worker/job_files/test_mirror.py \
		service/test_shared.py service/test_machines.py service/storage/trial_s3.py)

client:  ## the page's types anew from the service's OpenAPI document
	@cd web && npm run --silent client

lock:  ## resolve the dependencies anew into requirements.lock, requirements-dev.lock and web/package-lock.json
	@scripts/lock.sh

bench: tools  ## the figures of docs/figures.md
	@$(BIN)/python -m benchmarks.portrait

picture: setup  ## the README's picture
	@$(BIN)/python -m scripts.picture

pictures: setup  ## the pictures of docs/method.md and docs/personas.md
	@$(BIN)/python -m scripts.method_pictures
	@$(BIN)/python -m scripts.persona_picture

samples: tools  ## the pictures and clips of the start pages, in web/public/samples/
	@$(BIN)/python -m scripts.samples

licences:  ## docs/packages.md, from the installed packages
	@$(BIN)/python -m scripts.licences

docs: tools  ## the documentation as a site, in site/
	@scripts/docs.sh

wheel: setup  ## a wheel in dist/ that holds all that runs, the page included
	@rm -rf build dist
	@$(BIN)/python -m pip --disable-pip-version-check wheel --quiet --no-deps --no-build-isolation --wheel-dir dist .
	@ls dist/*.whl

clean:  ## remove what can be made again (keeps .venv and node_modules)
	@rm -rf build dist web/dist web/reactive/dist engine/portrait/reactive/player demo site var/test-reports benchmarks/out .coverage .pytest_cache .ruff_cache .mypy_cache .import_linter_cache .hypothesis

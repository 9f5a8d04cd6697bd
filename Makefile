# Every target that runs Python first creates .venv with the packages of requirements.lock.
.DEFAULT_GOAL := help
.PHONY: help walk test coverage fuzz lint docs gallery lock clean

BIN := .venv/bin
ARGS ?=
# Tests of one file run in one worker, so that they share its simulations. A worker that crashes ends the tests: with a
# replacement pytest-xdist 3.8 can wait forever.
PYTEST_ARGS ?= -n auto --maxprocesses 8 --dist loadfile --max-worker-restart 0

help: ## Show this list
	@sed -n 's/^\([a-z]*\):.*## /\1\t/p' Makefile | expand -t 8

walk: .venv/.installed ## Simulate a walk and write its run folder; options in ARGS="..."
	@$(BIN)/humanwalk walk $(ARGS)

test: .venv/.installed ## Run the tests; PYTEST_ARGS="..." replaces the options
	@DRAKE_ALLOW_NETWORK=meshcat:package_map OMP_NUM_THREADS=1 $(BIN)/pytest $(PYTEST_ARGS)

coverage: .venv/.installed ## Run the tests and print the share of humanwalk/ that they execute
	@DRAKE_ALLOW_NETWORK=meshcat:package_map OMP_NUM_THREADS=1 $(BIN)/pytest --cov $(PYTEST_ARGS)

fuzz: .venv/.installed ## Try random hostile files for ten minutes (HUMANWALK_FUZZ_SECONDS)
	@HUMANWALK_FUZZ_SECONDS=$${HUMANWALK_FUZZ_SECONDS:-600} DRAKE_ALLOW_NETWORK=meshcat:package_map OMP_NUM_THREADS=1 \
		$(BIN)/pytest tests/fuzz

lint: .venv/.installed ## Check style, types and import layers
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports

docs: .venv/.installed ## Build the book in build/docs; needs no network
	@NO_MKDOCS_2_WARNING=true $(BIN)/mkdocs build --strict

gallery: .venv/.installed ## Regenerate all pictures and videos of the book (a quarter of an hour)
	@$(BIN)/python docs/make_gallery.py

lock: .venv/.installed ## Update requirements.lock to the newest allowed versions
	$(BIN)/uv pip compile --quiet --universal --generate-hashes --no-header --no-annotate --upgrade \
		--python-version 3.12 --group dev --group docs --output-file requirements.lock pyproject.toml

clean: ## Remove .venv, caches and builds; keep runs
	rm -rf .venv build dist *.egg-info .hypothesis .mypy_cache .pytest_cache .ruff_cache .coverage* .import_linter_cache
	find humanwalk tests -name __pycache__ -type d -prune -exec rm -rf {} +

.venv/.installed: pyproject.toml requirements.lock
	@if ! $(BIN)/python -c 'import sys; sys.exit(sys.version_info < (3, 12))' 2>/dev/null; then \
		python=$$(sh tools/find_python.sh) || exit 1; \
		echo "humanwalk: making .venv with $$python (a few minutes, once)"; \
		"$$python" -m venv --clear .venv || exit 1; \
	fi
	@$(BIN)/python -m pip --version >/dev/null 2>&1 || $(BIN)/python -m ensurepip >/dev/null
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes -r requirements.lock
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --no-deps --editable .
	@$(BIN)/python -m pip check --disable-pip-version-check >/dev/null || \
		{ echo "humanwalk: requirements.lock does not fit pyproject.toml; run: make lock"; exit 1; }
	@touch $@

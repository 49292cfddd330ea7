# make run: the whole pipeline. make test: the tests. Both install what they need into .venv first.
PYTHON ?= python3
CORES ?= 2
BIN := .venv/bin
export MLFLOW_DISABLE_TELEMETRY := true

.PHONY: run unlock new-robot test test-run lint ui store campaigns benchmark coverage standins environment clean

run: .venv/installed
	$(BIN)/snakemake --cores $(CORES)

# After a kill -9 or a power cut, when no other run is going on: `make unlock run`.
unlock: .venv/installed
	$(BIN)/snakemake --unlock

# A robot of your own: make new-robot FILE=arm.csv shows a guess of its entry, with WRITE=1 config/datasets.yaml gets it.
new-robot: .venv/installed
	@$(BIN)/python -m softkin.new_robot "$(FILE)" $(if $(NAME),--name "$(NAME)") $(if $(WRITE),--write)

test: .venv/installed
	$(BIN)/pytest -m "not slow"

test-run: .venv/installed
	$(BIN)/snakemake --cores $(CORES) --directory results/test-run --configfile config/test.yaml

lint: .venv/installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint
	$(BIN)/mypy

ui: .venv/installed
	MLFLOW_SERVER_ENABLE_JOB_EXECUTION=false $(BIN)/mlflow ui --host 127.0.0.1 --workers 1

# Make the MLflow store anew, or bring it up to date, from results/.
store: .venv/installed
	$(BIN)/snakemake --cores $(CORES) --forcerun create_store track

# Long statistical and fault campaigns.
campaigns: .venv/installed
	$(BIN)/pytest -m slow

# How well the default run uses the machine: fit CPU against wall time, and the ten slowest jobs.
benchmark: .venv/installed
	$(BIN)/python benchmarks/utilisation.py --cores $(CORES)

# Whether intervals cover what they say, over random re-splits of a finished run.
coverage: .venv/installed
	$(BIN)/python benchmarks/coverage.py

# How long the stand-ins of all datasets take to simulate.
standins: .venv/installed
	$(BIN)/python benchmarks/standins.py

# Pin every dependency anew.
environment: .venv/installed
	$(BIN)/pip-compile --quiet --extra dev --allow-unsafe --strip-extras --no-header --no-annotate \
	  --no-emit-index-url --no-emit-find-links --no-emit-trusted-host --output-file environment.txt pyproject.toml

clean:
	rm -rf results .snakemake

# Bytecode is compiled here because some machines forbid it at run time, and imports are three times slower without.
.venv/installed: environment.txt pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check -r environment.txt
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	$(BIN)/python -m compileall -q .venv/lib src > /dev/null || true
	touch $@

# Most targets install what they need into .venv first. The comment above a target is its line in `make help`.
# Whether a person names the interpreter: then .venv is made anew where it has another one.
PYTHON_NAMED := $(filter command environment,$(firstword $(origin PYTHON)))
PYTHON ?= python3
CORES ?= 2
IN ?= .
PORT ?= 5000
AT ?= 03:17
KIND ?= all
BIN := .venv/bin
# What a person gives: recipes read it from their environment, "$$FILE", as it is. Written into a recipe as $(FILE) a quote
# or a $(...) in it would be run by the shell, and a $(...) by make.
GIVEN := PYTHON CORES IN FILE POSITIONS JOIN SHEET ROBOT MORE NAME HEADER DELIMITER ANSWER WRITE PORT KEEP NOTIFY AT KIND
$(foreach name,$(GIVEN),$(eval override $(name) := $$(value $(name))))
export $(GIVEN)
export MLFLOW_DISABLE_TELEMETRY := true
# Things run side by side, one core each: with more threads than that they wait for each other most of the time.
export OMP_NUM_THREADS := 1
# Packages of other people's environments, those of ROS for one, are no part of this one.
unexport PYTHONPATH PYTHONHOME
export PYTHONNOUSERSITE := 1
# Without a home that can be written to, libraries keep here what they keep there.
ifneq ($(shell test -w "$$HOME" && echo yes),yes)
export XDG_CACHE_HOME := $(CURDIR)/.venv/cache
export MPLCONFIGDIR := $(CURDIR)/.venv/cache/matplotlib
endif

.PHONY: help run demo campaign refit schedule prune unlock new-robot test test-parts test-workflow test-small-runs test-learning test-units other-pythons test-run lint ui store report verify
.PHONY: gallery numbers results-page single-rows
.PHONY: snakemake-report campaigns campaign-slurm coverage standins timings benchmark benchmark-large benchmark-pruning benchmark-shells
.PHONY: benchmark-figures benchmark-fit-rows benchmark-two-files benchmark-commands benchmark-robots benchmark-many-robots benchmark-recalibration benchmark-choice benchmark-promises
.PHONY: benchmark-latency latency-page benchmark-inverse benchmark-difficulty benchmark-peers benchmark-suggest
.PHONY: environment clean ui-screenshot bad-inputs-page faults-page

# These targets, each with the first sentence of the comment above it.
help:
	@awk '/^# / { text = text substr($$0, 2); next } \
	  /^[a-z][a-z-]*:/ && text { sub(/[.] .*|[.]$$/, "", text); sub(/:.*/, "", $$1); printf "make %-22s%s\n", $$1, text } \
	  { text = "" }' Makefile

# The whole pipeline: what is not up to date is made, and nothing else. ROBOT: one entry of datasets.yaml, and no other.
# MORE: a file that overrides the configuration key by key, such as config/few_trials.yaml.
run: .venv/installed
	$(BIN)/snakemake --cores "$$CORES" $${ROBOT:+--config datasets="[$$ROBOT]"} $${MORE:+--configfile "$$MORE"}

# A first look at everything, in a folder and a store of its own: one robot, few models, few trials.
demo: .venv/installed
	env -u MLFLOW_TRACKING_URI $(BIN)/snakemake --cores "$$CORES" --directory results/demo --configfile config/demo.yaml

# Clear what a killed run left, which every run does at its start. It is refused while another run goes on.
unlock: .venv/installed
	$(BIN)/snakemake --unlock

# First unlock, then what it is for, also with -j.
ifneq ($(filter unlock,$(MAKECMDGOALS)),)
$(filter-out unlock .venv/%,$(MAKECMDGOALS)): | unlock
endif

# Guess the entry of a robot of your own from FILE, or FILE and POSITIONS. WRITE=1: config/datasets.yaml gets it; ANSWER=1 or 2.
new-robot: .venv/installed
	@$(BIN)/python -m softkin.cli.new_robot $${NAME:+--name="$$NAME"} $${HEADER:+--header="$$HEADER"} $${DELIMITER:+--delimiter="$$DELIMITER"} \
	  $${SHEET:+--sheet="$$SHEET"} $${JOIN:+--join="$$JOIN"} $${ANSWER:+--answer="$$ANSWER"} $${WRITE:+--write} -- "$$FILE" $${POSITIONS:+"$$POSITIONS"}

# All tests but the long ones. Four parts side by side: those of the workflow wait for processes.
test: .venv/installed-dev
	$(MAKE) --no-print-directory -j 4 test-parts

# The same, as many at a time as -j says.
test-parts: test-workflow test-units test-learning test-small-runs

SMALL_RUNS := $(addprefix tests/workflow/test_,credentials.py dependencies.py failed_parts.py own_robot.py watching.py)
LEARNING := $(addprefix tests/,unit/models unit/training unit/uncertainty contract tools)

# The tests of the workflow that read one whole run, which they share.
test-workflow: .venv/installed-dev
	$(BIN)/pytest -m "not slow" tests/workflow $(addprefix --ignore=,$(SMALL_RUNS))

# The tests of the workflow with runs and plans of their own.
test-small-runs: .venv/installed-dev
	$(BIN)/pytest -m "not slow" $(SMALL_RUNS)

# The tests of each module that fits models or makes intervals, of every entry of a registry, of messages and of pages.
test-learning: .venv/installed-dev
	$(BIN)/pytest -m "not slow" $(LEARNING)

# The tests of each other module, and all that have no part of their own.
test-units: .venv/installed-dev
	$(BIN)/pytest -m "not slow" --ignore tests/workflow $(addprefix --ignore=,$(LEARNING))

# Python 3.12 and 3.13, where they are on this machine: the environment, a plan of the workflow, the tests of `core`.
other-pythons: .venv/installed
	$(BIN)/python -m tools.other_pythons 3.12 3.13

# The workflow on the configuration of the tests, in results/test-run.
test-run: .venv/installed
	$(BIN)/snakemake --cores "$$CORES" --directory results/test-run --configfile config/test.yaml

# Linters, formatters and the type checker.
lint: .venv/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint
	$(BIN)/mypy

# MLflow's UI on the store of the last run, with links to its views. IN: the folder of the run, such as results/demo.
ui: .venv/installed
	@$(BIN)/python -m softkin.cli.ui --directory="$$IN" --port="$$PORT"

# One unattended run with a verdict and an exit code. 0 same or better, 1 failed, 3 worse, 4 data for a person, 75 another
# one goes on; make itself prints it and ends with 2 where it is not 0.
# NOTIFY: a command that gets the verdict on its standard input. NOTIFY_URLS in the environment: URLs of Apprise.
campaign: .venv/installed
	$(BIN)/python -m softkin.cli.campaign --cores="$$CORES" $${NOTIFY:+--notify="$$NOTIFY"}

# A campaign with everything redone: the same numbers must come out.
refit: .venv/installed
	$(BIN)/python -m softkin.cli.campaign --cores="$$CORES" --refit $${NOTIFY:+--notify="$$NOTIFY"}

# What starts a campaign every day AT=03:17, ready to install. KIND: systemd, cron, github or all; docs/schedules.md.
schedule: .venv/installed
	@$(BIN)/python -m softkin.cli.schedule --at="$$AT" --kind="$$KIND" --cores="$$CORES" $${NOTIFY:+--notify="$$NOTIFY"}

# Remove all campaigns but the last KEEP from MLflow, and what was superseded before them; it says what.
prune: .venv/installed
	@$(BIN)/python -m softkin.cli.prune --keep="$${KEEP:?make prune KEEP=50}" --yes

# Make the MLflow store anew, or bring it up to date, from results/.
store: .venv/installed
	$(BIN)/snakemake --cores "$$CORES" --forcerun create_store track

# The page of the run, results/report.html, and nothing that it does not need.
report: .venv/installed
	$(BIN)/snakemake --cores "$$CORES" results/report.html

# Whether the results are what softkin wrote, and the tables what the stored predictions give. IN: the folder of the run.
verify: .venv/installed
	@$(BIN)/python -m softkin.cli.verify --in="$$IN"

# The pictures and the table of the README, from a finished run of the default configuration.
gallery: .venv/installed
	$(BIN)/python -m tools.gallery

# Snakemake's own report of a finished run: the same results with captions, and how each came about.
snakemake-report: .venv/installed
	$(BIN)/snakemake --report results/snakemake_report.html

# Long statistical and fault campaigns. PyElastica, which brings a compiler, and PostgreSQL are installed for them only;
# roc-validator gets an environment of its own, since typer prints otherwise where its packages are.
campaigns: .venv/installed-dev
	test -e .venv/roc-validator/bin/rocrate-validator || $(BIN)/python -m venv .venv/roc-validator
	.venv/roc-validator/bin/pip install --quiet --disable-pip-version-check roc-validator==0.13.0
	$(BIN)/pip install --quiet --disable-pip-version-check pyelastica==1.0.0 pgserver==0.1.4 psycopg2-binary==2.9.13
	$(BIN)/pytest -m slow

# The test configuration on a real SLURM of one node, MLflow on PostgreSQL. As root on Debian, which has the packages.
campaign-slurm: .venv/installed-dev
	$(BIN)/pip install --quiet --disable-pip-version-check snakemake-executor-plugin-slurm==2.8.0 pgserver==0.1.4 psycopg2-binary==2.9.13
	$(BIN)/pytest -m slow tests/workflow/test_slurm.py

# How well the default run uses the machine: fit CPU against wall time, and the ten slowest jobs.
benchmark: .venv/installed
	$(BIN)/python benchmarks/utilisation.py --cores "$$CORES"

# Whether intervals cover what they say, over random re-splits of a finished run.
coverage: .venv/installed
	$(BIN)/python -m benchmarks.coverage

# Whether a robot of a million rows goes through prepare and audit in a minute and 2 GB.
benchmark-large: .venv/installed
	$(BIN)/python benchmarks/large.py
	$(BIN)/python benchmarks/large.py --format csv

# What cutting trials short costs and saves, on FINGER of a finished run.
benchmark-pruning: .venv/installed
	$(BIN)/python benchmarks/pruning.py

# Whether robots of 2 to 64 commands and 10,000 rows go through with all models in 15 minutes and 4 GB each.
benchmark-commands: .venv/installed
	$(BIN)/python -m benchmarks.commands --cores "$$CORES"

# What a bound on the rows of a fit costs and saves, on simulated robots.
benchmark-fit-rows: .venv/installed
	$(BIN)/python -m benchmarks.fit_rows

# Whether an export of Motive and a log of commands of 60,000 rows become a calibrated model in 5 minutes.
benchmark-two-files: .venv/installed
	$(BIN)/python -m benchmarks.two_files --cores "$$CORES"

# One table of the robots in the folder IN, a file or a folder of files each: error, coverage, width, promise, findings.
benchmark-robots: .venv/installed
	$(BIN)/python -m benchmarks.robots --cores "$$CORES" -- "$$IN"

# Whether a dry run of 1,000 datasets takes at most 90 s and 1.5 GB, and how both grow with the number of datasets.
benchmark-many-robots: .venv/installed
	$(BIN)/python -m benchmarks.many_robots

# Whether intervals made from shells of `train` hold outside it, on simulated robots.
benchmark-shells: .venv/installed
	$(BIN)/python benchmarks/shells.py

# Which score picks the interval method that serves the rows that are no gross errors, on simulated robots.
benchmark-choice: .venv/installed
	$(BIN)/python -m benchmarks.choice

# Whether intervals cover hard commands as often as easy ones, on simulated robots.
benchmark-difficulty: .venv/installed
	$(BIN)/python -m benchmarks.difficulty

# docs/peers.md: FLAML, AutoGluon, CatBoost and a random search beside a finished run. It installs 2 GB in results/peers.
benchmark-peers: .venv/installed
	$(BIN)/python -m benchmarks.peers

# What a few labelled poses of a new session do to coverage and width, and how soon the alarm notices one.
benchmark-recalibration: .venv/installed
	$(BIN)/python -m benchmarks.recalibration $${SOFTKIN_DATA_MIRROR:+"$$SOFTKIN_DATA_MIRROR"}

# Whether intervals keep what they promise on 200 simulated recordings that lag, have play, drift and shift.
benchmark-promises: .venv/installed
	$(BIN)/python -m benchmarks.promises

# What an answer costs, of the models of a finished run, beside the bare estimator and the exports.
benchmark-latency: .venv/installed
	@$(BIN)/python -W ignore -m benchmarks.latency --environment $(wildcard results/*/calibrated_model.joblib)

# docs/latency.md, from the same.
latency-page: .venv/installed
	$(BIN)/python -W ignore -m benchmarks.latency --environment $(wildcard results/*/calibrated_model.joblib) > results/latency.jsonl
	$(BIN)/python -m tools.latency_page results/latency.jsonl

# Commands for targets, beside the damped least squares of the dataset's authors; sent to simulated robots.
benchmark-inverse: .venv/installed
	$(BIN)/python -m benchmarks.inverse $${SOFTKIN_DATA_MIRROR:+"$$SOFTKIN_DATA_MIRROR"}

# How many suggested commands teach a model as much as 50 and 100 random ones, on simulated robots.
benchmark-suggest: .venv/installed
	$(BIN)/python -m benchmarks.suggest

# Whether the figures of a robot of 100,000 rows stay under 500 MB.
benchmark-figures: .venv/installed
	$(BIN)/python -m benchmarks.figures

# How long the stand-ins of all datasets take to simulate.
standins: .venv/installed
	$(BIN)/python benchmarks/standins.py

# What the tables of a finished run of the default configuration say: to compare before and after a change.
numbers: .venv/installed
	@$(BIN)/python -m tools.print_numbers

# Which numbers and verdicts of a finished run hang on a single row; it ends with 1 where a verdict does.
single-rows: .venv/installed
	@$(BIN)/python -m tools.single_rows

# resources/timings.csv, which the estimate of the time left starts from. It takes a run of the default configuration that
# was made here alone on the machine, from nothing.
timings: .venv/installed
	$(BIN)/python -m tools.timings

# docs/bad_inputs.md: what softkin answers to each bad input of the tests.
bad-inputs-page: .venv/installed-dev
	$(BIN)/python -m tools.bad_inputs_page

# docs/faults.md: what happens after each fault of the tests.
faults-page: .venv/installed-dev
	$(BIN)/python -m tools.faults_page

# docs/results.md, its gallery with it, and docs/claims.md, from a finished run of the default configuration.
results-page: .venv/installed
	$(BIN)/python -m tools.results_page
	$(BIN)/python -m tools.claims_page
	$(BIN)/python -m tools.gallery

# The picture of the MLflow UI in the README, docs/mlflow_ui.png, from the store of a finished run.
ui-screenshot: .venv/installed-dev
	$(BIN)/python -m tools.ui_screenshot

COMPILE := pip-compile --quiet --allow-unsafe --strip-extras --no-header --no-annotate \
  --no-emit-index-url --no-emit-find-links --no-emit-trusted-host --extra install

# Pin every dependency anew, what a run installs by the hashes of its files: pip refuses any other.
environment: .venv/installed-dev
	$(BIN)/$(COMPILE) --extra dev --output-file environment-dev.txt pyproject.toml
	$(BIN)/$(COMPILE) --generate-hashes --constraint environment-dev.txt --output-file environment.txt pyproject.toml

# Remove all results and what Snakemake knows of them.
clean:
	rm -rf results .snakemake

# Where the environment takes softkin from: that of a project that was copied or moved runs the code of another folder.
# And which interpreter it has.
ORIGIN := import importlib.util as u, os; print(os.path.realpath(u.find_spec("softkin").origin + "/../../.."))
INTERPRETER := import sys; print(sys.version, getattr(sys, "base_prefix", ""))
VERSION := import sys; print(".".join(map(str, sys.version_info[:3]))); sys.exit(sys.version_info < (3, 11))

# Newer than .venv/installed when the environment has to be made anew: it is not whole, of another folder, or has
# another interpreter than the one that was asked for.
.venv/place: always
	@if test -e .venv/installed && \
	    test "$$($(BIN)/python -I -c '$(ORIGIN)' 2> /dev/null)" = "$$(pwd -P)" && \
	    { test -z "$(PYTHON_NAMED)" || \
	      test "$$($(BIN)/python -I -c '$(INTERPRETER)')" = "$$("$$PYTHON" -c '$(INTERPRETER)' 2> /dev/null)"; }; then \
	  test -e $@ || touch -r .venv/installed $@; \
	elif version="$$("$$PYTHON" -c '$(VERSION)' 2> /dev/null)"; then \
	  rm -rf .venv && mkdir .venv && touch $@; \
	else \
	  printf 'softkin: it needs Python 3.11 or newer, and "%s" is %s; name another one, such as PYTHON=python3.12\n' \
	    "$$PYTHON" "$${version:-none}" >&2; exit 1; \
	fi

.PHONY: always
always:

# Bytecode is compiled here because some machines forbid it at run time, and imports are three times slower without.
.venv/installed: environment.txt pyproject.toml .venv/place
	test -e $(BIN)/pip || "$$PYTHON" -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check -r environment.txt
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	$(BIN)/python -m compileall -q .venv/lib src > /dev/null || true
	touch $@

# What tests and checks need besides, 300 MB.
.venv/installed-dev: .venv/installed environment-dev.txt
	$(BIN)/pip install --quiet --disable-pip-version-check -r environment-dev.txt
	$(BIN)/python -m compileall -q .venv/lib > /dev/null || true
	touch $@

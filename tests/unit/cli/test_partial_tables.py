"""Which datasets are complete when a job has failed, and how their tables are asked for."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import pytest

from softkin.cli.partial_tables import PARTIAL, Undone, complete_datasets, run_without, what_is_missing
from softkin.core.files import read_json

DATASETS = ["arm", "finger", "trunk"]
FAILED = Undone("fit_model", "finger", "fit_model gp", failed=True)
NOT_STARTED = Undone("calibrate", "finger", "calibrate", failed=False)
TABLES = Undone("build_tables", "", "build_tables", failed=False)


def test_a_dataset_with_a_job_undone_is_left_out_and_named() -> None:
    undone = [FAILED, NOT_STARTED, TABLES]
    assert complete_datasets(DATASETS, undone) == ["arm", "trunk"]
    assert what_is_missing(DATASETS, ["arm", "trunk"], undone) == "Incomplete: without finger (fit_model gp failed)."


def test_a_dataset_that_waited_in_vain_is_named_without_a_job() -> None:
    undone = [FAILED, Undone("prepare", "arm", "prepare", failed=False)]
    assert what_is_missing(DATASETS, ["trunk"], undone) == "Incomplete: without arm, finger (fit_model gp failed)."


def test_where_tables_themselves_failed_there_is_nothing_to_make() -> None:
    failed = Undone("build_tables", "", "build_tables", failed=True)
    assert complete_datasets(DATASETS, [failed]) == []


def test_a_store_that_fails_takes_no_tables() -> None:
    """They are made by the run itself."""
    assert complete_datasets(DATASETS, [Undone("track", "arm", "track", failed=True)]) == []


def test_where_no_dataset_is_complete_there_is_nothing_to_make() -> None:
    assert complete_datasets(["finger"], [FAILED]) == []


def test_they_are_asked_for_with_a_caution_and_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    called: list[Any] = []

    def run(command: list[str], env: dict[str, str], check: bool) -> subprocess.CompletedProcess[str]:
        called.append((command, env, check))
        return subprocess.CompletedProcess(command, 3)

    monkeypatch.setattr(subprocess, "run", run)
    config = {"datasets": DATASETS, "caution": "Few trials.", "seed": 1}
    assert run_without("Incomplete.", ["arm"], config, command=["snakemake"], report="results/report.html") == 3
    ((command, environment, _),) = called
    assert command[0] == "snakemake"
    assert command[-2:] == ["--", "results/report.html"]
    assert "track" not in command
    assert environment[PARTIAL] == "1"
    assert PARTIAL not in os.environ
    given = read_json(command[command.index("--configfile") + 1])
    assert given == {"datasets": ["arm"], "caution": "Incomplete. Few trials.", "seed": 1}

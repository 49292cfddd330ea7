"""What tables are made of when a job has failed, and how they are asked for."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from softkin.cli.partial_tables import PARTIAL, LeftOut, Partial, Undone, plan, run_partial
from softkin.core.files import read_json

CONFIG: dict[str, Any] = {
    "datasets": ["arm", "finger", "trunk"],
    "models": ["lr", "gp"],
    "ensembles": ["ensemble"],
    "quantile_models": ["gb"],
    "interval_methods": ["qr", "scp_mapie", "auto"],
    "regions": ["joint_box"],
    "presets": ["paper", "tuned"],
    "sources": {"arm": {}, "finger": {}, "trunk": {}},
}
GP = Undone("fit_model", "finger", "fit_model gp", failed=True, parts=[("models", "gp")])
MEAN = Undone("fit_ensemble", "finger", "fit_ensemble ensemble", failed=False, parts=[("ensembles", "ensemble")])
WAITS = [MEAN, *(Undone(rule, "finger", rule, failed=False) for rule in ("refit", "calibrate", "score", "track"))]
TABLES = Undone("build_tables", "", "build_tables", failed=False)


def planned(
    *undone: Undone,
    left_out: Mapping[str, LeftOut] | None = None,
    complete: Collection[str] | None = None,
    **config: Any,
) -> Partial | None:
    return plan(CONFIG | config, undone, left_out=left_out or {}, on_quantiles=["qr", "cqr"], complete=complete)


def test_a_dataset_is_complete_where_no_job_of_its_tables_is_undone() -> None:
    """A run of tables of what is there knows a dataset for complete if the one before did: its own jobs may all be
    done, and some of them of less.
    """
    tracked = Undone("track", "arm", "track", failed=False)
    first = planned(GP, *WAITS, TABLES, tracked)
    assert first is not None
    others = [name for name in CONFIG["datasets"] if name != "finger"]
    assert "arm" in others
    assert first.complete == others
    waits = planned(GP, *WAITS, Undone("score", "arm", "score", failed=False))
    assert waits is not None
    assert waits.complete == [name for name in others if name != "arm"]
    second = planned(GP, *WAITS, complete=["arm"])
    assert second is not None
    assert second.complete == ["arm"]


def test_a_dataset_does_without_a_model_that_failed_and_it_is_named() -> None:
    """An ensemble, which waited for all models, is made of the others."""
    partial = planned(GP, *WAITS, TABLES)
    assert partial is not None
    assert partial.datasets == CONFIG["datasets"]
    assert partial.left_out == {"finger": {"models": ["gp"]}}
    assert partial.missing == "Incomplete: without the model gp on finger (fit_model gp failed)."


@pytest.mark.parametrize(
    ("rule", "part", "words"),
    [
        ("calibrate", ("interval_methods", "auto"), "the interval method auto on finger (calibrate failed)"),
        ("score", ("regions", "joint_box"), "the region joint_box on finger (score failed)"),
        ("refit", ("models", "gp"), "the model gp on finger (refit failed)"),
    ],
)
def test_a_dataset_does_without_what_a_job_of_it_failed_on(rule: str, part: tuple[str, str], words: str) -> None:
    partial = planned(Undone(rule, "finger", rule, failed=True, parts=[part]))
    assert partial is not None
    assert partial.left_out == {"finger": {part[0]: [part[1]]}}
    assert partial.missing == f"Incomplete: without {words}."


@pytest.mark.parametrize("rule", ["retrieve", "prepare", "calibrate", "score", "draw_figures"])
def test_a_dataset_is_left_out_where_nobody_knows_what_it_could_do_without(rule: str) -> None:
    partial = planned(Undone(rule, "finger", rule, failed=True), GP)
    assert partial is not None
    assert partial.datasets == ["arm", "trunk"]
    assert partial.left_out == {}
    assert partial.missing == f"Incomplete: without finger ({', '.join(sorted([rule, 'fit_model gp']))} failed)."


def test_a_dataset_does_without_an_ensemble_that_failed() -> None:
    partial = planned(replace(MEAN, failed=True), *WAITS[1:], TABLES)
    assert partial is not None
    assert partial.left_out == {"finger": {"ensembles": ["ensemble"]}}
    assert partial.missing == "Incomplete: without the ensemble ensemble on finger (fit_ensemble ensemble failed)."


def test_a_dataset_is_left_out_where_no_model_or_no_method_is_left() -> None:
    lr = Undone("fit_model", "finger", "fit_model lr", failed=False, parts=[("models", "lr")])
    partial = planned(GP, lr)
    assert partial is not None
    assert partial.datasets == ["arm", "trunk"]
    assert partial.missing == "Incomplete: without finger (fit_model gp failed)."
    regressor = Undone("fit_quantiles", "arm", "fit_quantiles gb", failed=True, parts=[("quantile_models", "gb")])
    partial = planned(regressor, interval_methods=["qr", "cqr"])
    assert partial is not None
    assert partial.datasets == ["finger", "trunk"]


def test_methods_that_need_quantiles_go_with_the_last_quantile_regressor() -> None:
    regressor = Undone("fit_quantiles", "arm", "fit_quantiles gb", failed=True, parts=[("quantile_models", "gb")])
    partial = planned(regressor)
    assert partial is not None
    assert partial.left_out == {"arm": {"quantile_models": ["gb"], "interval_methods": ["qr"]}}
    partial = planned(regressor, quantile_models=["gb", "xgb"])
    assert partial is not None
    assert partial.left_out == {"arm": {"quantile_models": ["gb"]}}


def test_a_run_that_left_something_out_and_failed_leaves_that_out_too() -> None:
    before = {"finger": {"models": ["gp"]}, "arm": {"regions": ["joint_box"]}}
    failed = Undone("calibrate", "finger", "calibrate", failed=True, parts=[("interval_methods", "auto")])
    partial = planned(failed, left_out=before)
    assert partial is not None
    assert partial.left_out == before | {"finger": {"models": ["gp"], "interval_methods": ["auto"]}}
    assert partial.missing == "Incomplete: without the interval method auto on finger (calibrate failed)."


@pytest.mark.parametrize(
    "undone",
    [
        Undone("build_tables", "", "build_tables", failed=True),
        Undone("track", "arm", "track", failed=True),  # its tables are made by the run itself
    ],
)
def test_where_no_dataset_lacks_anything_there_is_nothing_to_make(undone: Undone) -> None:
    assert planned(undone) is None


def test_where_no_dataset_is_left_there_is_nothing_to_make() -> None:
    assert planned(Undone("prepare", "finger", "prepare", failed=True), datasets=["finger"]) is None


def test_they_are_asked_for_with_a_caution_and_what_is_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    called: list[Any] = []

    def run(command: list[str], env: dict[str, str], check: bool) -> subprocess.CompletedProcess[str]:
        called.append((command, env, check))
        return subprocess.CompletedProcess(command, 3)

    monkeypatch.setattr(subprocess, "run", run)
    config = CONFIG | {"caution": "Few trials.", "seed": 1, "sources": {"arm": {"presets": ["tuned"]}}}
    partial = Partial(["arm"], {"arm": {"models": ["gp"]}}, "Incomplete.", ["arm"])
    assert run_partial(partial, config, command=["snakemake"], cores=2, report="results/report.html") == 3
    ((command, environment, _),) = called
    assert command[:3] == ["snakemake", "--cores", "2"]
    assert command[-2:] == ["--", "results/report.html"]
    assert not {"track", "fit_model"} & set(command)
    assert json.loads(environment[PARTIAL]) == {"left_out": {"arm": {"models": ["gp"]}}, "complete": ["arm"]}
    assert PARTIAL not in os.environ
    given = read_json(command[command.index("--configfile") + 1])
    assert given == config | {"datasets": ["arm"], "caution": "Incomplete. Few trials."}
    assert {"calibrate", "calibrate_arm", "refit_arm"} <= set(command)

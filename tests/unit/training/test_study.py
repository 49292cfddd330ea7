from __future__ import annotations

import inspect
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from optuna.trial import Trial

from softkin.core.errors import DataError
from softkin.core.files import read_json
from softkin.core.imported_code import code_hash
from softkin.core.runs import TUNED
from softkin.core.samples import Params
from softkin.models import MODELS
from softkin.training.held_out import Robot
from softkin.training.study import (
    KEPT_PERCENT,
    STARTUP_TRIALS,
    Search,
    StudyFile,
    TuningResult,
    TuningSettings,
    bounded_rows,
    fingerprint,
    record,
    run_study,
)
from softkin.training.tune import SearchSettings, held_out_rows, tune_model
from tests.conftest import bending_arm

SETTINGS = TuningSettings(n_trials=8, n_folds=3, max_rows=60, seed=3)
TIMES = ["seconds", "cpu_seconds"]


def study(path: Path, model: str = "lasso", tuning: TuningSettings = SETTINGS) -> TuningResult:
    robot = Robot(base=None, standardised_norm=False)
    search = SearchSettings({TUNED: tuning.n_trials}, [TUNED], 2, [0.7], ["cartesian"])
    return tune_model(
        bending_arm(90),
        held_out=held_out_rows(
            bending_arm(90), spec=MODELS[model], robot=robot, settings=tuning, search=search, threads=1
        ),
        preset=TUNED,
        settings=tuning,
        search=search,
        file=StudyFile(path, code_hash(inspect.getfile(MODELS[model].build))),
    )


def untimed(trials: pd.DataFrame) -> pd.DataFrame:
    return trials.drop(columns=TIMES)


@settings(max_examples=20)
@given(st.integers(20, 200))
def test_rows_of_a_trial_are_bounded_distinct_and_in_order(max_rows: int) -> None:
    rows = bending_arm(150, n_commands=3, n_markers=2)
    kept = bounded_rows(rows, max_rows, 0)
    assert len(kept) == min(150, max_rows)
    places = [int(np.flatnonzero((rows.commands == row).all(axis=1))[0]) for row in kept.commands]
    assert places == sorted(set(places))


def test_the_number_of_trials_is_a_total_and_a_longer_study_continues(tmp_path: Path) -> None:
    short = study(tmp_path / "a.journal", tuning=replace(SETTINGS, n_trials=5))
    again = study(tmp_path / "a.journal", tuning=replace(SETTINGS, n_trials=5))
    pd.testing.assert_frame_equal(short.trials, again.trials)
    longer = study(tmp_path / "a.journal")
    assert len(longer.trials) == 8
    pd.testing.assert_frame_equal(untimed(longer.trials), untimed(study(tmp_path / "b.journal").trials))
    shorter = study(tmp_path / "a.journal", tuning=replace(SETTINGS, n_trials=5))
    pd.testing.assert_frame_equal(shorter.trials, short.trials, check_dtype=False)


def test_a_study_belongs_to_its_fingerprint() -> None:
    rows, spec = bending_arm(60), MODELS["lr"]
    marks = [
        fingerprint(spec.name, rows, SETTINGS, "code"),
        fingerprint(spec.name, bending_arm(61), SETTINGS, "code"),
        fingerprint("lasso", rows, SETTINGS, "code"),
        *(
            fingerprint(spec.name, rows, replace(SETTINGS, **{key: 7}), "code")
            for key in ("n_folds", "max_rows", "seed")
        ),
    ]
    assert fingerprint(spec.name, rows, replace(SETTINGS, n_trials=99), "code") == marks[0]
    marks.append(fingerprint(spec.name, rows, SETTINGS, "other code"))
    assert len(set(marks)) == len(marks)


def test_another_seed_starts_a_new_study(tmp_path: Path) -> None:
    study(tmp_path / "a.journal")
    other = study(tmp_path / "a.journal", tuning=replace(SETTINGS, seed=4))
    fresh = study(tmp_path / "b.journal", tuning=replace(SETTINGS, seed=4))
    pd.testing.assert_frame_equal(untimed(other.trials), untimed(fresh.trials))


def parabola(*, first_trials: tuple[Mapping[str, Any], ...] = (), worst: float = 10.0) -> Search:
    """Two parts with the error (x - 1)^2 each; infinite from x = `worst` on."""

    def space(trial: Trial) -> Params:
        return {"x": trial.suggest_float("x", -10.0, 10.0)}

    def errors_of(params: Params) -> Iterator[float]:
        for _ in range(2):
            yield (params["x"] - 1.0) ** 2 if params["x"] < worst else float("inf")

    return Search("parabola", space, first_trials, errors_of, n_parts=2)


def test_the_first_trials_come_first_and_the_best_complete_one_wins(tmp_path: Path) -> None:
    starts = ({"x": -3.0}, {"x": 1.5}, {"x": 4.0})
    search = parabola(first_trials=starts)
    file = StudyFile(tmp_path / "a.journal", "code")
    result = run_study(bending_arm(20), search=search, settings=replace(SETTINGS, n_trials=3), file=file)
    assert result.trials["param_x"].tolist() == [-3.0, 1.5, 4.0]
    assert (result.params, result.score_mm) == ({"x": 1.5}, 0.25)
    assert [score for _, score in result.complete] == [0.25, 9.0, 16.0]
    longer = run_study(bending_arm(20), search=search, settings=SETTINGS, file=file)
    assert longer.score_mm <= 0.25
    assert longer.fingerprint == result.fingerprint


def test_a_trial_of_infinite_error_is_pruned_and_has_no_score(tmp_path: Path) -> None:
    search = parabola(first_trials=({"x": 0.0}, {"x": 9.0}), worst=5.0)
    file = StudyFile(tmp_path / "a.journal", "code")
    result = run_study(bending_arm(20), search=search, settings=replace(SETTINGS, n_trials=2), file=file)
    assert result.trials["state"].tolist() == ["COMPLETE", "PRUNED"]
    assert result.trials["score_mm"].tolist() == pytest.approx([1.0, np.nan], nan_ok=True)
    assert result.trials["n_parts_scored"].tolist() == [2, 1]
    kept = record(result)
    assert (kept["n_trials"], kept["n_pruned"], kept["fingerprint"]) == (2, 1, result.fingerprint)
    assert kept["cpu_seconds"] >= 0


def test_a_study_without_any_score_is_an_error_that_names_its_file(tmp_path: Path) -> None:
    file = StudyFile(tmp_path / "a.journal", "code")
    with pytest.raises(DataError, match="none of 2 trials could be scored") as caught:
        run_study(bending_arm(20), search=parabola(worst=-10.0), settings=replace(SETTINGS, n_trials=2), file=file)
    assert caught.value.where == str(tmp_path / "a.journal")
    assert caught.value.fix


def test_the_best_trial_is_a_whole_cross_validation(tmp_path: Path) -> None:
    result = study(tmp_path / "a.journal", "svr", replace(SETTINGS, n_trials=14))
    complete = result.trials[result.trials["state"] == "COMPLETE"]
    assert result.score_mm == complete["score_mm"].min()
    assert (complete["n_parts_scored"] == 3).all()
    pruned = result.trials[result.trials["state"] == "PRUNED"]
    assert len(pruned) > 0
    assert (pruned["n_parts_scored"] < 3).all()
    assert pruned["score_mm"].isna().all()
    assert result.trials["first_part_mm"].gt(0).all()
    # Nearly the best on the first part, or not carried further.
    late = complete[complete["trial"] >= STARTUP_TRIALS]
    for trial, first in zip(late["trial"], late["first_part_mm"], strict=True):
        earlier = complete.loc[complete["trial"] < trial, "first_part_mm"]
        assert first <= np.percentile(earlier, KEPT_PERCENT)


WORKER = """
import sys
from pathlib import Path
from tests.unit.training.test_study import SETTINGS, study
from softkin.core.files import write_json
result = study(Path(sys.argv[1]), sys.argv[2])
result.trials.to_csv(sys.argv[3], index=False)
write_json(sys.argv[3] + ".best", {"params": result.params, "score": result.score_mm})
"""


def worker(folder: Path, name: str, model: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-c", WORKER, str(folder / f"{name}.journal"), model, str(folder / f"{name}.csv")]
    root = Path(__file__).parents[3]
    env = {**os.environ, "PYTHONPATH": f"{root / 'src'}{os.pathsep}{root}"}
    return subprocess.Popen(command, cwd=root, env=env, stderr=subprocess.DEVNULL)


def size_of(journal: Path) -> int:
    return journal.stat().st_size if journal.exists() else -1


def kill_at(folder: Path, model: str, size: float) -> bool:
    """Run a study and kill it -9 as soon as its journal has `size` bytes; whether that hit it."""
    process = worker(folder, "killed", model)
    while size_of(folder / "killed.journal") < size and process.poll() is None:
        time.sleep(0.001)
    hit = process.poll() is None
    process.send_signal(signal.SIGKILL)
    process.wait()
    return hit


def assert_same_end(folder: Path) -> None:
    killed, undisturbed = (pd.read_csv(folder / f"{name}.csv") for name in ("killed", "undisturbed"))
    pd.testing.assert_frame_equal(untimed(killed), untimed(undisturbed), check_exact=True)
    assert read_json(folder / "killed.csv.best") == read_json(folder / "undisturbed.csv.best")


def test_a_killed_study_ends_as_an_undisturbed_one(tmp_path: Path) -> None:
    """Only what is killed needs a process of its own."""
    undisturbed = study(tmp_path / "undisturbed.journal", "svr")
    assert kill_at(tmp_path, "svr", 0.4 * size_of(tmp_path / "undisturbed.journal"))
    killed = study(tmp_path / "killed.journal", "svr")
    pd.testing.assert_frame_equal(untimed(killed.trials), untimed(undisturbed.trials), check_exact=True)
    assert (killed.params, killed.score_mm) == (undisturbed.params, undisturbed.score_mm)


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("model", MODELS)
def test_campaign_kill_at_any_moment(tmp_path: Path, model: str) -> None:
    """Twelve kills for every model: two while it starts, study creation included, ten as soon as it has written a
    random number of bytes more. After every other one the journal loses some last bytes, as in a power cut.
    """
    rng = random.Random(f"campaign {model}")
    assert worker(tmp_path, "undisturbed", model).wait() == 0
    journal, whole = tmp_path / "killed.journal", size_of(tmp_path / "undisturbed.journal")
    for _ in range(2):
        process = worker(tmp_path, "killed", model)
        time.sleep(rng.uniform(0.3, 2.5))
        process.send_signal(signal.SIGKILL)
        process.wait()
    hits = 0
    for kill in range(10):
        hits += kill_at(tmp_path, model, size_of(journal) + rng.uniform(0.0, 2.0) * whole / SETTINGS.n_trials)
        if kill % 2:
            os.truncate(journal, max(0, size_of(journal) - rng.randrange(1, 300)))
    assert worker(tmp_path, "killed", model).wait() == 0
    print(f"{model}: {hits} of 10 kills hit a study at work; journal {size_of(journal)} bytes, undisturbed {whole}")
    assert_same_end(tmp_path)

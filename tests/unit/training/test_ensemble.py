from __future__ import annotations

from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
import pytest

from softkin.core.files import read_json
from softkin.core.job_records import record_job
from softkin.core.runs import OUTER, SEARCHED, TUNED, Run
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, Array, Samples, coordinate_columns
from softkin.data.table import read_subset, to_table, write_table
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.training.ensemble import EnsembleFiles, MemberFiles, Pool, fit_ensemble
from softkin.training.fit import FitFiles, fit
from softkin.training.held_out import HeldOut, PartSettings, Robot, parts_of, write_held_out
from softkin.training.kinematic_model import FitSettings
from softkin.training.members import members_of
from tests.conftest import bending_arm

ROBOT = Robot(base=None, standardised_norm=False)
SETTINGS = PartSettings(n_folds=3, core_shares=(0.6, 0.8), max_rows=100, max_markers=1, scores=(TUNED, OUTER), seed=0)
SPEC = ENSEMBLES["ensemble"]
#: Two runs that bend too little and too much outside, and a line.
RUNS: dict[Run, dict[str, Any]] = {
    Run("lr", TUNED): {"degree": 3, "target_space": "cartesian"},
    Run("ridge", OUTER): {"degree": 2, "alpha": 0.1, "target_space": "curvature"},
    Run("lr", OUTER): {"degree": 1, "target_space": "cartesian"},
}


@pytest.fixture(scope="module")
def members(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[Run, MemberFiles]]:
    """The folder of a project with the table of a robot and the files of its searched runs."""
    folder = tmp_path_factory.mktemp("project")
    subsets = {subset: bending_arm(60, n_markers=2, seed=seed) for seed, subset in enumerate(SUBSETS)}
    table = folder / "results" / "arm" / "table.parquet"
    table.parent.mkdir(parents=True)
    write_table(to_table(subsets), table)
    rows, parts = parts_of(subsets[TRAIN], SETTINGS, ROBOT)
    files = {}
    for run, params in RUNS.items():
        place = table.parent / run.model / run.preset
        place.mkdir(parents=True)
        of_run = MemberFiles(
            *(place / name for name in ("model.joblib", "fit.json", "held_out.npz", "predictions.parquet"))
        )
        write_held_out(HeldOut(MODELS[run.model], rows, parts, ROBOT, 0, 1), params, of_run.held_out)
        own = {name: value for name, value in params.items() if name != "target_space"}
        settings = FitSettings(own, True, 0, 1, target_space=params["target_space"])
        of_fit = FitFiles(of_run.model, of_run.record, of_run.predictions)
        fit(table, spec=MODELS[run.model], settings=settings, files=of_fit)
        record_job(folder / "results" / "logs" / "fit_model" / "arm" / f"{run.model}_{run.preset}.log", [of_run.model])
        files[run] = of_run
    return folder, files


def fitted(table: Path, members: dict[Run, MemberFiles], folder: Path) -> dict[str, EnsembleFiles]:
    names = ("model.joblib", "fit.json", "predictions.parquet", "parameters.json", "trials.csv")
    files = {}
    for preset in SEARCHED:
        (folder / preset).mkdir(parents=True)
        files[preset] = EnsembleFiles(*(folder / preset / name for name in names))
    fit_ensemble(table, spec=SPEC, robot=ROBOT, settings=SETTINGS, members=members, files=files, threads=1)
    return files


@pytest.fixture(scope="module")
def ensemble(members: Any, tmp_path_factory: pytest.TempPathFactory) -> dict[str, EnsembleFiles]:
    folder, of_runs = members
    return fitted(folder / "results" / "arm" / "table.parquet", of_runs, tmp_path_factory.mktemp("ensemble"))


def stored(predictions: str | Path, subset: str) -> Array:
    frame = pd.read_parquet(predictions)
    return np.asarray(frame.loc[frame["subset"] == subset, coordinate_columns(2)].to_numpy())


@pytest.mark.parametrize("preset", SEARCHED)
def test_it_predicts_the_weighted_mean_of_its_members(ensemble: Any, members: Any, preset: str) -> None:
    table = members[0] / "results" / "arm" / "table.parquet"
    weights = members_of(Run("ensemble", preset), ensemble[preset].record)
    assert len(weights) > 1
    assert sum(weights.values()) == pytest.approx(1.0)
    estimator = joblib.load(ensemble[preset].model)
    for subset in (TEST, EXTRAPOLATION):
        of_members = [stored(members[1][run].record.with_name("predictions.parquet"), subset) for run in weights]
        expected = np.tensordot(list(weights.values()), of_members, axes=1)
        predicted = stored(ensemble[preset].predictions, subset)
        np.testing.assert_allclose(predicted, expected, rtol=1e-12)
        np.testing.assert_array_equal(estimator.predict(read_subset(table, subset).inputs), predicted)


@pytest.mark.parametrize(("preset", "score"), [(TUNED, "cv_mae_mm"), (OUTER, "shell_mae_mm")])
def test_its_last_step_is_no_worse_than_any_run_and_its_score_is_of_parts_left_out(
    ensemble: Any, members: Any, preset: str, score: str
) -> None:
    rows, parts = parts_of(read_subset(members[0] / "results" / "arm" / "table.parquet", TRAIN), SETTINGS, ROBOT)
    of_runs = [(HeldOut(MODELS[run.model], rows, parts, ROBOT, 0, 1), params) for run, params in RUNS.items()]
    alone = [held_out.predicted(params, preset)[1] for held_out, params in of_runs]
    best, steps = read_json(ensemble[preset].parameters), pd.read_csv(ensemble[preset].trials)
    assert steps["score_mm"].min() < min(alone)
    assert steps["score_mm"][0] == min(alone), "the first step is the best run alone, to the bit"
    assert best["n_trials"] == len(steps)
    assert steps["score_mm"].min() < best[score] < np.inf


def test_its_files_say_what_those_of_any_run_say(ensemble: Any, members: Any) -> None:
    record, best = read_json(ensemble[OUTER].record), read_json(ensemble[OUTER].parameters)
    of_run = read_json(members[1][Run("lr", TUNED)].record)
    assert set(of_run) <= set(record)
    assert record["n_train"] == 60
    assert record["params"] == {f"{one['model']}/{one['preset']}": one["weight"] for one in record["members"]}
    assert {"target_space", "memory", "params", "cv_mae_mm", "shell_mae_mm", "n_pruned", "cpu_seconds"} <= set(best)
    fits = [read_json(members[1][run].record)["fit_seconds"] for run in members_of(Run("", ""), ensemble[OUTER].record)]
    assert record["fit_seconds"] == pytest.approx(sum(fits))


def test_rows_that_are_not_of_train_do_not_change_a_weight(ensemble: Any, members: Any, tmp_path: Path) -> None:
    folder, of_runs = members
    subsets = {name: read_subset(folder / "results" / "arm" / "table.parquet", name) for name in SUBSETS}
    garbage = {s: Samples(rows.commands, 1e6 - rows.positions) for s, rows in subsets.items() if s != TRAIN}
    write_table(to_table(subsets | garbage), tmp_path / "garbage.parquet")
    again = fitted(tmp_path / "garbage.parquet", of_runs, tmp_path / "again")
    for preset in SEARCHED:
        for kind in ("trials", "predictions"):
            one, other = (Path(getattr(of_preset[preset], kind)) for of_preset in (ensemble, again))
            assert one.read_bytes() == other.read_bytes()
        assert read_json(again[preset].record)["members"] == read_json(ensemble[preset].record)["members"]


GOOD, BAD = Run("lr", TUNED), Run("gp", TUNED)


def test_a_run_without_a_score_is_no_member_for_it_and_leaves_the_mean_without_one() -> None:
    truth = {TUNED: [np.zeros((3, 1))], OUTER: [np.zeros((2, 1)), np.zeros((1, 1))]}
    predicted = {GOOD: {TUNED: np.ones((3, 1)), OUTER: np.ones((3, 1))}, BAD: {TUNED: -np.ones((3, 1))}}
    pool = Pool(truth, predicted)
    both = {GOOD: 0.5, BAD: 0.5}
    assert pool.steps(SPEC, TUNED, [0]).best == both
    assert pool.score(both, TUNED) == 0.0
    assert pool.score(both, OUTER) == np.inf
    assert pool.steps(SPEC, OUTER, [0, 1]).best == {GOOD: 1.0}
    assert pool.score({GOOD: 1.0}, OUTER) == 1.0


def test_a_score_is_of_weights_picked_on_other_parts() -> None:
    """Each run is right on one part alone, where the other is 1 off: picked there, and wrong on the other part."""
    truth = {TUNED: [np.zeros((2, 1)), np.zeros((2, 1))]}
    predicted = {GOOD: {TUNED: np.array([[0.0], [0.0], [1.0], [1.0]])}, BAD: {TUNED: np.array([[1.0], [1], [0], [0]])}}
    pool = Pool(truth, predicted)
    assert pool.left_out_score(SPEC, TUNED) == 1.0
    assert min(map(np.mean, pool.steps(SPEC, TUNED, [0, 1]).errors)) == 0.5
    alone = Pool({TUNED: truth[TUNED][:1]}, {run: {TUNED: stored[TUNED][:2]} for run, stored in predicted.items()})
    assert alone.left_out_score(SPEC, TUNED) == 0.0, "of one part there is no other"

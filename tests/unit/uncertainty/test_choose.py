from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.csv_tables import read_csv
from softkin.core.errors import ConfigError
from softkin.core.run_archive import RunArchive
from softkin.core.runs import Run
from softkin.core.samples import SUBSETS
from softkin.data.table import read_subset, to_table, write_table
from softkin.uncertainty.calibration_data import PointCalibration, SpreadCalibration
from softkin.uncertainty.choose import Resplittable, choose, deployed_choice, resplits, shown_runs
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs
from tests.conftest import bending_arm
from tests.unit.uncertainty.conftest import garbled, quantile_calibration, spread_calibration

GP, GB, LR = Run("gp", "tuned"), Run("gb", "paper"), Run("lr", "tuned")


@pytest.mark.parametrize("data", [spread_calibration(50), quantile_calibration(50)])
def test_calibration_rows_are_split_and_never_scored_by_themselves(data: Resplittable) -> None:
    axis = 0 if data.calibration.ndim == 2 else 1
    seen: list[int] = []
    for part, held_out in resplits(data, 0):
        kept = np.setdiff1d(np.arange(50), held_out)
        np.testing.assert_array_equal(part.calibration, data.calibration.take(kept, axis))
        np.testing.assert_array_equal(part.new, data.calibration.take(held_out, axis))
        np.testing.assert_array_equal(part.truth, data.truth[kept])
        if isinstance(data, SpreadCalibration):
            assert isinstance(part, SpreadCalibration)
            np.testing.assert_array_equal(part.new_spread, data.calibration_spread[held_out])
        seen += held_out.tolist()
    assert sorted(seen) == list(range(50))


@pytest.fixture
def noisy(tmp_path: Path) -> Path:
    """Folder of a table, predictions off by a mm, far better quantiles, and a shell of the run `GP`."""
    rng = np.random.default_rng(0)
    subsets = {subset: bending_arm(120, seed=place) for place, subset in enumerate(SUBSETS)}
    write_table(to_table(subsets), tmp_path / "t.parquet")
    predictions = to_table(subsets).drop(columns=["u1", "u2"])
    predictions.iloc[:, 1:] += rng.standard_normal((len(predictions), 3))
    predictions.to_parquet(tmp_path / "p.parquet")
    quantiles = [
        bounds_frame(np.stack([rows.positions - half, rows.positions + half], axis=-1), subset, level)
        for subset, rows in subsets.items()
        if subset != "train"
        for level, half in ((0.8, 0.01), (0.9, 0.02))
    ]
    pd.concat(quantiles).to_parquet(tmp_path / "q.parquet")
    rows = np.arange(60)
    shared = {"core_0": rows, "shell_0": rows + 60, "centre": np.zeros(2), "scale": np.ones(2)}
    RunArchive(shared, {(GP, "0"): subsets["train"].positions[60:]}).write(tmp_path / "s.npz")
    return tmp_path


@pytest.mark.parametrize(
    ("regime", "run", "in_extrapolation"),
    [
        ("auto", GP, "auto"),
        ("in_domain", GP, "scp_mapie"),
        ("auto", LR, "scp_mapie"),  # nothing of this run was fitted on a core
    ],
)
def test_what_is_deployed_is_around_a_model_and_has_another_method_in_extrapolation_where_there_are_shells(
    noisy: Path, regime: str, run: Run, in_extrapolation: str
) -> None:
    outputs = StoredOutputs(
        noisy / "t.parquet",
        predictions={run: noisy / "p.parquet"},
        quantiles={GB: noisy / "q.parquet"},
        refits=None,
        confidence_levels=[0.8, 0.9],
        shells=noisy / "s.npz" if run == GP else None,
    )
    methods = {name: INTERVAL_METHODS[name] for name in ("scp_mapie", "cqr", "auto")}
    choose(outputs, methods=methods, runs=[run], seed=0, regime=regime, choice=noisy / "c.csv")
    best = pd.read_csv(noisy / "c.csv").iloc[0]
    assert (best["interval_method"], best["chosen"], best["deployed"]) == ("cqr", True, False)
    deployed = deployed_choice(noisy / "c.csv")
    assert deployed is not None
    assert (deployed["model"], deployed["interval_method"]) == (run.model, "scp_mapie")
    assert deployed["outside"] == in_extrapolation


def test_where_only_quantile_regressors_are_candidates_nothing_is_deployed(noisy: Path) -> None:
    outputs = StoredOutputs(
        noisy / "t.parquet",
        predictions={},
        quantiles={GB: noisy / "q.parquet"},
        refits=None,
        confidence_levels=[0.8, 0.9],
    )
    methods = {"cqr": INTERVAL_METHODS["cqr"]}
    choose(outputs, methods=methods, runs=[GP], seed=0, regime="auto", choice=noisy / "c.csv")
    assert deployed_choice(noisy / "c.csv") is None


@pytest.fixture
def heteroscedastic(tmp_path: Path) -> Path:
    """Folder of a table and of predictions whose errors are as large as their spread says, 0.01 or 1 mm."""
    rng = np.random.default_rng(0)
    subsets = {subset: bending_arm(300, seed=place) for place, subset in enumerate(SUBSETS)}
    predictions = to_table(subsets).drop(columns=["u1", "u2"])
    for coordinate in ("m1_x", "m1_y", "m1_z"):
        predictions[f"std_{coordinate}"] = rng.choice([0.01, 1.0], len(predictions))
        predictions[coordinate] += predictions[f"std_{coordinate}"] * rng.standard_normal(len(predictions))
    predictions.to_parquet(tmp_path / "p.parquet")
    write_table(to_table(subsets), tmp_path / "t.parquet")
    return tmp_path


def outputs_of(table: Path) -> StoredOutputs:
    predictions = table.parent / "p.parquet"
    return StoredOutputs(
        table, predictions={GP: predictions, GB: predictions}, quantiles={}, refits=None, confidence_levels=[0.8, 0.9]
    )


def test_errors_that_grow_with_the_spread_choose_the_normalised_method(heteroscedastic: Path) -> None:
    """And nothing of `test` is looked at: its truth is garbage."""
    garbage = garbled(heteroscedastic / "t.parquet", ("test", "extrapolation"), heteroscedastic / "garbage.parquet")
    choices = []
    for table in (heteroscedastic / "t.parquet", garbage):
        out = table.with_suffix(".csv")
        choose(outputs_of(table), methods=INTERVAL_METHODS, runs=[GP], seed=0, regime="in_domain", choice=out)
        choices.append(pd.read_csv(out))
    pd.testing.assert_frame_equal(*choices)
    best = choices[0].iloc[0]
    assert (best["model"], best["interval_method"], best["chosen"]) == ("gp", "scp_spread", True)
    assert set(choices[0]["model"]) == {"gp"}
    assert choices[0]["deployed"].tolist() == choices[0]["chosen"].tolist()
    assert (choices[0]["outside"] == choices[0]["interval_method"]).all()
    assert choices[0]["cv_winkler_typical_mm"].is_monotonic_increasing
    assert (choices[0]["cv_winkler_typical_mm"] <= choices[0]["cv_winkler_mm"]).all()
    assert (choices[0]["cv_winkler_without_gross_mm"] == choices[0]["cv_winkler_mm"]).all()
    assert not {"gaussian", "qr", "cv_plus"} & set(choices[0]["interval_method"])
    assert read_subset(garbage, "test").positions.min() > 1e5
    assert shown_runs(heteroscedastic / "t.csv") == {GB, GP}


def test_a_handful_of_failed_rows_cannot_decide(tmp_path: Path) -> None:
    """Three of 240 rows are 50 mm off. The mean Winkler score prefers quantiles that are wide everywhere and widest in
    these rows, and a hundred times worse in all others.
    """
    rng = np.random.default_rng(0)
    subsets = {subset: bending_arm(240, seed=place) for place, subset in enumerate(SUBSETS)}
    failed = {subset: rng.choice(240, 3, replace=False) for subset in SUBSETS}
    predictions = to_table(subsets).drop(columns=["u1", "u2"])
    predictions.iloc[:, 1:] += 0.01 * rng.standard_normal((len(predictions), 3))
    predictions.to_parquet(tmp_path / "p.parquet")
    frames = []
    for subset, rows in subsets.items():
        half, centre = np.full((240, 1), 1.0), rows.positions + rng.uniform(-1, 1, (240, 3))
        half[failed[subset]] = 60.0
        bounds = np.stack([centre - half, centre + half], axis=-1)
        frames += [bounds_frame(bounds, subset, level) for level in (0.8, 0.9)]
        rows.positions[failed[subset]] += 50.0
    pd.concat(frames[2:]).to_parquet(tmp_path / "q.parquet")
    write_table(to_table(subsets), tmp_path / "t.parquet")
    outputs = StoredOutputs(
        tmp_path / "t.parquet",
        predictions={GP: tmp_path / "p.parquet"},
        quantiles={GB: tmp_path / "q.parquet"},
        refits=None,
        confidence_levels=[0.8, 0.9],
    )
    methods = {name: INTERVAL_METHODS[name] for name in ("scp_mapie", "cqr")}
    choose(outputs, methods=methods, runs=[GP], seed=0, regime="in_domain", choice=tmp_path / "c.csv")
    choice = pd.read_csv(tmp_path / "c.csv").set_index("interval_method")
    assert choice.index[0] == "scp_mapie"
    assert choice["cv_winkler_mm"].idxmin() == "cqr"
    assert choice["cv_winkler_without_gross_mm"].idxmin() == "scp_mapie"
    assert choice["cv_winkler_without_gross_mm"].min() < 0.06


def test_without_a_calibrated_method_there_is_nothing_to_choose(heteroscedastic: Path) -> None:
    only, never = {"gaussian": INTERVAL_METHODS["gaussian"]}, heteroscedastic / "never.csv"
    outputs = outputs_of(heteroscedastic / "t.parquet")
    with pytest.raises(ConfigError, match="add scp_mapie") as caught:
        choose(outputs, methods=only, runs=[GP], seed=0, regime="in_domain", choice=never)
    assert caught.value.where == "interval_methods"
    assert not never.exists()


def test_where_all_scores_are_infinite_the_lowest_level_decides(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Of five rows of `validation` four calibrate: enough for 80 %, too few for 90 %."""
    rng = np.random.default_rng(0)
    subsets = {subset: bending_arm(5 if subset == "validation" else 40, seed=p) for p, subset in enumerate(SUBSETS)}
    write_table(to_table(subsets), tmp_path / "t.parquet")
    for name, noise in (("bad", 5.0), ("good", 0.1)):
        predictions = to_table(subsets).drop(columns=["u1", "u2"])
        predictions.iloc[:, 1:] += noise * rng.standard_normal((len(predictions), 3))
        predictions.to_parquet(tmp_path / f"{name}.parquet")
    outputs = StoredOutputs(
        tmp_path / "t.parquet",
        predictions={GP: tmp_path / "bad.parquet", LR: tmp_path / "good.parquet"},
        quantiles={},
        refits=None,
        confidence_levels=[0.8, 0.9],
    )
    methods = {"scp_mapie": INTERVAL_METHODS["scp_mapie"]}
    choose(outputs, methods=methods, runs=[GP, LR], seed=0, regime="in_domain", choice=tmp_path / "choice.csv")
    assert ",infinite," in (tmp_path / "choice.csv").read_text()
    choice = read_csv(tmp_path / "choice.csv")
    assert np.isinf(choice["cv_winkler_typical_mm"]).all()
    assert list(choice["model"]) == ["lr", "gp"]
    assert "tie" not in choice
    assert "too few rows for intervals at 90 %: methods are compared at 80 %" in caplog.text


def test_rows_of_one_block_stay_in_one_fold() -> None:
    block = np.repeat(np.arange(7), 3)
    zero = np.zeros((21, 3))
    data = PointCalibration(zero, zero, zero[:1], zero[:, :1], zero[:, :1], zero[:1, :1])
    folds = [set(block[held_out].tolist()) for _, held_out in resplits(data, 0, block)]
    assert sorted(number for fold in folds for number in fold) == list(range(7))
    few = [held_out for _, held_out in resplits(data, 0, block % 2)]
    assert sorted(np.concatenate(few).tolist()) == list(range(21))

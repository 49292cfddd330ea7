from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.errors import SoftkinError
from softkin.core.files import write_json
from softkin.core.samples import SUBSETS, Samples
from softkin.data.table import read_subset, to_table, write_table
from softkin.training.selection import run_of_choice
from softkin.uncertainty.choose import choose, deployed_choice, parts, shown_runs
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs
from tests.conftest import bending_arm
from tests.unit.intervals.test_engines import quantile_evidence, spread_evidence


def test_the_run_is_the_one_of_lowest_score_by_the_objective(tmp_path: Path) -> None:
    files = {}
    for model, scores in {"lr": (0.5, 1.0), "gp": (0.1, 9.0), "svr": (0.1, 9.0)}.items():
        files[model, "tuned"] = tmp_path / f"{model}.json"
        found = dict(zip(("cv_mae_mm", "shell_mae_mm"), scores, strict=True))
        write_json(files[model, "tuned"], found | {"target_space": "cartesian"})
    assert run_of_choice(files, "interpolation") == ("gp", "tuned")
    assert run_of_choice(files, "extrapolation") == ("lr", "tuned")


def test_calibration_rows_are_split_and_never_judged_by_themselves() -> None:
    for evidence in (spread_evidence(50), quantile_evidence(50)):
        axis = 0 if evidence.calibration.ndim == 2 else 1
        seen = []
        for part, outside in parts(evidence, 0):
            inside = np.setdiff1d(np.arange(50), outside)
            np.testing.assert_array_equal(part.calibration, evidence.calibration.take(inside, axis))
            np.testing.assert_array_equal(part.new, evidence.calibration.take(outside, axis))
            np.testing.assert_array_equal(part.truth, evidence.truth[inside])
            if evidence.calibration_spread is not None and part.new_spread is not None:
                np.testing.assert_array_equal(part.new_spread, evidence.calibration_spread[outside])
            seen += outside.tolist()
        assert sorted(seen) == list(range(50))


def test_what_is_deployed_is_around_a_model_and_has_another_method_outside_where_there_are_shells(
    tmp_path: Path,
) -> None:
    rng = np.random.default_rng(0)
    subsets = {subset: bending_arm(120, seed=place) for place, subset in enumerate(SUBSETS)}
    write_table(to_table(subsets), tmp_path / "t.parquet")
    stored = to_table(subsets).drop(columns=["u1", "u2"])
    stored.iloc[:, 1:] += rng.standard_normal((len(stored), 3))
    stored.to_parquet(tmp_path / "p.parquet")
    quantiles = [
        bounds_frame(np.stack([rows.positions - half, rows.positions + half], axis=-1), subset, level)
        for subset, rows in subsets.items()
        if subset != "train"
        for level, half in ((0.8, 0.01), (0.9, 0.02))
    ]
    pd.concat(quantiles).to_parquet(tmp_path / "q.parquet")
    rows = np.arange(60)
    shells = {"core_0": rows, "shell_0": rows + 60, "gp/tuned/0": subsets["train"].positions[60:]}
    np.savez(tmp_path / "s.npz", **shells, centre=np.zeros(2), scale=np.ones(2))
    methods = {name: INTERVAL_METHODS[name] for name in ("scp_mapie", "cqr", "auto")}
    for regime, run, outside in (
        ("auto", ("gp", "tuned"), "auto"),
        ("inside", ("gp", "tuned"), "scp_mapie"),
        ("auto", ("lr", "tuned"), "scp_mapie"),  # nothing of this run was fitted on a core
    ):
        outputs = StoredOutputs(
            tmp_path / "t.parquet",
            predictions={run: tmp_path / "p.parquet"},
            quantiles={("gb", "paper"): tmp_path / "q.parquet"},
            refits=None,
            confidence_levels=[0.8, 0.9],
            shells=tmp_path / "s.npz" if run[0] == "gp" else None,
        )
        choose(outputs, methods=methods, runs=[run], seed=0, regime=regime, choice=tmp_path / "c.csv")
        best = pd.read_csv(tmp_path / "c.csv").iloc[0]
        assert (best["interval_method"], best["chosen"], best["deployed"]) == ("cqr", True, False)
        mine = deployed_choice(tmp_path / "c.csv")
        assert mine is not None
        assert (mine["model"], mine["interval_method"], mine["outside"]) == (run[0], "scp_mapie", outside)


def test_errors_that_grow_with_the_spread_choose_the_normalised_method(tmp_path: Path) -> None:
    """And nothing of `test` is looked at: its truth is garbage."""
    rng = np.random.default_rng(0)
    subsets = {subset: bending_arm(300, seed=place) for place, subset in enumerate(SUBSETS)}
    stored = to_table(subsets).drop(columns=["u1", "u2"])
    for coordinate in ("m1_x", "m1_y", "m1_z"):
        stored[f"std_{coordinate}"] = rng.choice([0.01, 1.0], len(stored))
        stored[coordinate] += stored[f"std_{coordinate}"] * rng.standard_normal(len(stored))
    stored.to_parquet(tmp_path / "p.parquet")
    choices = []
    for place, garbage in enumerate((False, True)):
        rows = dict(subsets)
        if garbage:
            rows |= {s: Samples(r.commands, 1e6 + r.positions) for s, r in subsets.items() if "t" in s and s != "train"}
            rows["validation"] = subsets["validation"]
        write_table(to_table(rows), tmp_path / "t.parquet")
        outputs = StoredOutputs(
            tmp_path / "t.parquet",
            predictions={("gp", "tuned"): tmp_path / "p.parquet", ("gb", "paper"): tmp_path / "p.parquet"},
            quantiles={},
            refits=None,
            confidence_levels=[0.8, 0.9],
        )
        out = tmp_path / f"{place}.csv"
        choose(outputs, methods=INTERVAL_METHODS, runs=[("gp", "tuned")], seed=0, regime="inside", choice=out)
        choices.append(pd.read_csv(out))
    pd.testing.assert_frame_equal(*choices)
    best = choices[0].iloc[0]
    assert (best["model"], best["interval_method"], best["chosen"]) == ("gp", "scp_spread", True)
    assert set(choices[0]["model"]) == {"gp"}
    assert choices[0]["deployed"].tolist() == choices[0]["chosen"].tolist()
    assert (choices[0]["outside"] == choices[0]["interval_method"]).all()
    assert choices[0]["cv_winkler_mm"].is_monotonic_increasing
    assert not {"gaussian", "qr", "cv_plus"} & set(choices[0]["interval_method"])
    only = {"gaussian": INTERVAL_METHODS["gaussian"]}
    with pytest.raises(SoftkinError, match="add scp_mapie"):
        choose(outputs, methods=only, runs=[("gp", "tuned")], seed=0, regime="inside", choice=tmp_path / "never.csv")
    assert read_subset(tmp_path / "t.parquet", "test").positions.min() > 1e5
    assert shown_runs(tmp_path / "0.csv") == {("gb", "paper"), ("gp", "tuned")}

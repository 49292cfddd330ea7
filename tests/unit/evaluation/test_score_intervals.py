from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.bounds import bounds_frame
from softkin.core.csv_tables import read_csv
from softkin.core.errors import DataError
from softkin.core.runs import Run
from softkin.data.table import read_subset, to_table, write_table
from softkin.evaluation.score_intervals import score_intervals
from softkin.uncertainty.calibrate import calibrate
from softkin.uncertainty.intervals import INTERVAL_METHODS
from softkin.uncertainty.intervals.spec import MARGINAL, NO_GUARANTEE
from softkin.uncertainty.promise import promised_methods
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs
from tests.conftest import four_subsets
from tests.unit.uncertainty.conftest import refits_of

LEVELS = [0.8, 0.9]
RUN = Run("gb", "paper")
COLUMNS = {
    *("dataset", "subset", "model", "preset", "interval_method", "coordinate", "confidence_level", "coverage"),
    *("coverage_low", "coverage_high", "coverage_p_value", "mean_width_mm", "winkler_mm", "n_calibration", "n_rows"),
    *("infinite_share", "crossing_share", "n_commands", "n_gross_rows", "winkler_without_gross_mm"),
}


@pytest.fixture
def metrics(table: Path, tmp_path: Path) -> pd.DataFrame:
    """scp_mapie: 4 mm wide, the first 20 of 40 rows missed by 1 mm in x. qr: infinite; raw quantiles crossed in z."""
    intervals, quantiles = [], []
    for subset in ("test", "extrapolation"):
        true = read_subset(table, subset).positions
        centre = true.copy()
        centre[:20, 0] += 3.0
        for level in LEVELS:
            frame = bounds_frame(np.stack([centre - 2, centre + 2], axis=-1), subset, level)
            intervals.append(frame)
            raw = np.stack([true - 1, true + 1], axis=-1)
            raw[:, 2] = raw[:, 2, ::-1]
            quantiles.append(bounds_frame(raw, subset, level))
    files = {name: tmp_path / f"{name}.parquet" for name in ("scp_mapie", "qr", "quantiles")}
    stored = pd.concat(intervals).assign(model="gb", preset="paper")
    stored.to_parquet(files["scp_mapie"])
    infinite = stored.copy()
    infinite.loc[:, infinite.columns.str.startswith("lower")] = -np.inf
    infinite.loc[:, infinite.columns.str.startswith("upper")] = np.inf
    infinite.to_parquet(files["qr"])
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions.to_parquet(tmp_path / "predictions.parquet")
    quantiles += [quantiles[0].assign(subset="validation", confidence_level=level) for level in LEVELS]
    pd.concat(quantiles).to_parquet(files["quantiles"])
    outputs = StoredOutputs(
        table,
        predictions={RUN: tmp_path / "predictions.parquet"},
        quantiles={RUN: files["quantiles"]},
        refits=None,
        confidence_levels=LEVELS,
    )
    score_intervals(
        table,
        dataset="arm",
        methods={name: INTERVAL_METHODS[name] for name in ("scp_mapie", "qr")},
        intervals={name: files[name] for name in ("scp_mapie", "qr")},
        regions={"joint_box": REGION_METHODS["joint_box"]},
        outputs=outputs,
        output=tmp_path / "metrics.csv",
    )
    return read_csv(tmp_path / "metrics.csv")


def rows(metrics: pd.DataFrame, **wanted: object) -> pd.DataFrame:
    for column, value in wanted.items():
        metrics = metrics[metrics[column] == value]
    return metrics.set_index("coordinate")


def test_a_row_for_each_coordinate_and_average(metrics: pd.DataFrame) -> None:
    assert set(metrics.columns) >= COLUMNS
    assert len(metrics) == 2 * 2 * (2 * 6 + 1)  # subsets, levels; two methods, one region
    assert set(metrics["coordinate"]) == {"m1_x", "m1_y", "m1_z", "mean", "mean_informative", "joint"}
    assert set(metrics["n_rows"]) == {40}
    assert set(rows(metrics, interval_method="scp_mapie")["n_calibration"]) == {40}
    assert set(rows(metrics, interval_method="qr")["n_calibration"]) == {0}
    box = metrics[metrics["interval_method"] == "joint_box"]
    assert set(box["coordinate"]) == {"joint"}


def test_known_misses_are_scored(metrics: pd.DataFrame) -> None:
    scores = rows(metrics, interval_method="scp_mapie", subset="test", confidence_level=0.9)
    assert scores.loc["m1_x", "coverage"] == 0.5
    assert scores.loc["m1_x", "winkler_mm"] == pytest.approx(4 + 0.5 * 20 * 1)
    assert (scores["winkler_without_gross_mm"] - scores["winkler_mm"]).abs().max() < 1e-9  # no row is gross
    assert (set(scores["n_commands"]), set(scores["n_gross_rows"])) == ({40}, {0})
    assert scores.loc["m1_y", ["coverage", "winkler_mm"]].tolist() == pytest.approx([1.0, 4.0])
    assert scores.loc["mean", "coverage"] == pytest.approx((0.5 + 1 + 1) / 3)
    assert scores.loc["joint", "coverage"] == 0.5
    assert scores.loc["m1_x", "coverage_p_value"] < scores.loc["m1_y", "coverage_p_value"]
    assert scores.loc["m1_x", "coverage"] < scores.loc["m1_x", "coverage_low"]
    assert (scores["coverage_p_value_holm"].dropna() >= scores["coverage_p_value"].dropna()).all()


def test_in_extrapolation_nothing_is_guaranteed(metrics: pd.DataFrame) -> None:
    far = rows(metrics, interval_method="scp_mapie", subset="extrapolation", confidence_level=0.9)
    assert set(far["guarantee"]) == {NO_GUARANTEE}
    assert far["coverage_p_value"].isna().all()
    assert far.loc["m1_x", "coverage_low"] < 0.5 < far.loc["m1_x", "coverage_high"]
    near = rows(metrics, interval_method="scp_mapie", subset="test", confidence_level=0.9)
    assert near.loc["m1_x", "guarantee"] == MARGINAL
    raw = rows(metrics, interval_method="qr", subset="test", confidence_level=0.9)
    assert set(raw["guarantee"]) == {NO_GUARANTEE}


def test_infinite_intervals_and_crossings_are_counted(metrics: pd.DataFrame, tmp_path: Path) -> None:
    scores = rows(metrics, interval_method="qr", subset="test", confidence_level=0.9)
    assert set(scores["infinite_share"]) == {1.0}
    assert np.isinf(scores.loc["mean", "mean_width_mm"])
    text = (tmp_path / "metrics.csv").read_text()
    assert ",infinite," in text
    assert ",inf," not in text
    assert scores.loc[["m1_x", "m1_y", "m1_z"], "crossing_share"].tolist() == [0.0, 0.0, 1.0]
    assert scores.loc["joint", "crossing_share"] == 1.0
    assert set(rows(metrics, interval_method="scp_mapie")["crossing_share"]) == {0.0}


def test_a_winkler_score_below_twice_the_mean_absolute_error_stops_the_run(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, metrics: pd.DataFrame
) -> None:
    assert len(metrics)
    monkeypatch.setattr("softkin.evaluation.score_intervals.winkler_scores", lambda true, *_: np.zeros_like(true))
    outputs = StoredOutputs(
        table,
        predictions={RUN: tmp_path / "predictions.parquet"},
        quantiles={},
        refits=None,
        confidence_levels=LEVELS,
    )
    with pytest.raises(DataError, match="below twice the mean absolute error") as caught:
        score_intervals(
            table,
            dataset="arm",
            methods={"scp_mapie": INTERVAL_METHODS["scp_mapie"]},
            intervals={"scp_mapie": tmp_path / "scp_mapie.parquet"},
            regions={},
            outputs=outputs,
            output=tmp_path / "never.csv",
        )
    assert caught.value.where == str(tmp_path / "scp_mapie.parquet")
    assert not (tmp_path / "never.csv").exists()


def test_calibration_rows_are_those_that_a_method_is_calibrated_on(tmp_path: Path) -> None:
    """Of `train` where it refits, of `validation` where it does not, none without a guarantee; a distribution has a
    CRPS.
    """
    table, run = tmp_path / "sizes.parquet", Run("mlp", "paper")
    write_table(to_table(four_subsets({"train": 50, "validation": 30, "test": 20, "extrapolation": 20})), table)
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    predictions.assign(std_m1_x=1.0, std_m1_y=1.0, std_m1_z=1.0).to_parquet(tmp_path / "predictions.parquet")
    refits_of(table).write(tmp_path / "refits.npz")
    outputs = StoredOutputs(
        table,
        predictions={run: tmp_path / "predictions.parquet"},
        quantiles={},
        refits=tmp_path / "refits.npz",
        confidence_levels=LEVELS,
    )
    methods = {name: INTERVAL_METHODS[name] for name in ("cv_plus", "scp_crepes", "cps", "gaussian")}
    intervals = {name: tmp_path / f"{name}.parquet" for name in methods}
    calibrate(outputs, methods=methods, in_domain={}, intervals=intervals)
    score_intervals(
        table,
        dataset="arm",
        methods=methods,
        intervals=intervals,
        regions={},
        outputs=outputs,
        output=tmp_path / "sizes.csv",
    )
    frame = pd.read_csv(tmp_path / "sizes.csv")
    counts = frame.groupby("interval_method")["n_calibration"].unique().map(list).to_dict()
    assert counts == {"cv_plus": [50], "scp_crepes": [30], "cps": [30], "gaussian": [0]}
    has_crps = frame[frame["coordinate"] == "mean"].groupby("interval_method")["crps_mm"].count() > 0
    assert has_crps.to_dict() == {"cv_plus": False, "scp_crepes": False, "cps": True, "gaussian": True}


@pytest.mark.parametrize(("n_blocks", "of_90"), [(12, "marginal, by block"), (3, "no guarantee (3 blocks)")])
def test_what_blocks_promise_stands_beside_the_coverage(table: Path, tmp_path: Path, n_blocks: int, of_90: str) -> None:
    frame = pd.read_parquet(table)
    frame["block"] = np.arange(len(frame)) % n_blocks
    frame.attrs = {}
    frame.to_parquet(tmp_path / "blocks.parquet")
    frame.drop(columns=["u1", "u2", "block"]).to_parquet(tmp_path / "predictions.parquet")
    outputs = StoredOutputs(
        tmp_path / "blocks.parquet",
        predictions={RUN: tmp_path / "predictions.parquet"},
        quantiles={},
        refits=None,
        confidence_levels=[0.9],
    )
    methods = promised_methods({"scp_crepes": INTERVAL_METHODS["scp_crepes"]}, outputs.promise)
    intervals = {"scp_crepes": tmp_path / "scp_crepes.parquet"}
    calibrate(outputs, methods=methods, in_domain={}, intervals=intervals)
    score_intervals(
        tmp_path / "blocks.parquet",
        dataset="arm",
        methods={"scp_crepes": INTERVAL_METHODS["scp_crepes"]},
        intervals=intervals,
        regions={"joint_box": REGION_METHODS["joint_box"]},
        outputs=outputs,
        output=tmp_path / "metrics.csv",
    )
    metrics = pd.read_csv(tmp_path / "metrics.csv")
    mean = metrics[metrics["coordinate"] == "mean"].set_index("subset")["guarantee"]
    assert mean.to_dict() == {"test": of_90, "extrapolation": "no guarantee"}
    region = metrics[(metrics["interval_method"] == "joint_box") & (metrics["subset"] == "test")]
    assert region["guarantee"].tolist() == ["joint, by block" if n_blocks == 12 else of_90]

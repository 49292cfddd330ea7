from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from softkin.core.runs import Run
from softkin.core.samples import EXTRAPOLATION, SUBSETS, TEST, TRAIN, VALIDATION, Array
from softkin.data.table import read_subset
from softkin.evaluation.score_regions import (
    alarm_rates,
    coverage_row,
    covered_share,
    moving_residuals,
    region_rows,
    score_alarms,
)
from softkin.uncertainty.promise import Promise
from softkin.uncertainty.regions import REGION_METHODS
from softkin.uncertainty.stored_outputs import StoredOutputs

MARKERS = np.repeat([0, 1], 3)
NO_BLOCKS = dict.fromkeys(SUBSETS)


def residuals(seed: int, n: int = 88) -> dict[str, Array]:
    rng = np.random.default_rng(seed)
    return {s: rng.standard_normal((n, 6)) * np.repeat([0.2, 2.0], 3) for s in (TRAIN, VALIDATION, TEST, EXTRAPOLATION)}


def test_false_alarms_are_as_many_as_promised() -> None:
    """300 times: without displacement the mean share of alarms is alpha (n + 1) rounded down / (n + 1), jointly and
    per coordinate; moved by 5 mm nearly every row is noticed.
    """
    shares = []
    for seed in range(300):
        rows = [r for r in alarm_rates(residuals(seed), MARKERS, 0.9, seed, NO_BLOCKS, None) if r["subset"] == TEST]
        still = next(row for row in rows if row["displacement_mm"] == 0)
        moved = next(row for row in rows if row["displacement_mm"] == 5)
        shares.append([still["joint_alarm_rate"], still["coordinate_alarm_rate"], moved["joint_alarm_rate"]])
    expected = 8 / 89
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(300)
    np.testing.assert_array_less(np.abs(means[:2] - expected), 4 * errors[:2])
    assert expected <= 0.1
    assert means[2] > 0.95


def test_false_alarms_of_blocks_are_as_many_as_promised() -> None:
    """200 times: of 18 blocks whose rows are the same the share is 1/19, where counting rows would give 2/19."""
    shares = []
    for seed in range(200):
        alike = {subset: np.repeat(of_blocks, 5, axis=0) for subset, of_blocks in residuals(seed, 18).items()}
        blocks = dict.fromkeys(SUBSETS, np.repeat(np.arange(18), 5))
        first = next(alarm_rates(alike, MARKERS, 0.9, seed, blocks, Promise(18, 5)))
        shares.append([first["joint_alarm_rate"], first["coordinate_alarm_rate"]])
        assert np.isnan(first["joint_low"])
    means, errors = np.mean(shares, axis=0), np.std(shares, axis=0) / np.sqrt(200)
    np.testing.assert_array_less(np.abs(means - 1 / 19), 4 * errors)


@pytest.fixture
def outputs(table: Path, tmp_path: Path) -> StoredOutputs:
    predictions = pd.read_parquet(table).drop(columns=["u1", "u2"])
    coordinates = ["m1_x", "m1_y", "m1_z"]
    predictions[coordinates] += np.random.default_rng(0).standard_normal((len(predictions), 3))
    predictions.to_parquet(tmp_path / "predictions.parquet")
    return StoredOutputs(
        table,
        predictions={Run("lr", "paper"): tmp_path / "predictions.parquet"},
        quantiles={},
        refits=None,
        confidence_levels=[0.8, 0.9],
    )


def test_a_row_for_every_region_level_and_subset(table: Path, outputs: StoredOutputs) -> None:
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    rows = pd.DataFrame(region_rows(outputs, samples, REGION_METHODS))
    assert len(rows) == len(REGION_METHODS) * 2 * 2
    assert set(rows["coordinate"]) == {"joint"}
    far = rows[rows["subset"] == "extrapolation"]
    assert set(far["guarantee"]) == {"no guarantee"}
    assert far["coverage_p_value"].isna().all()
    near = rows[(rows["subset"] == "test") & (rows["interval_method"] == "joint_box")]
    assert set(near["guarantee"]) == {"joint"}
    assert near["coverage_p_value"].between(0, 1).all()
    assert near["coverage"].between(near["coverage_low"], near["coverage_high"]).all()


def test_the_coverage_of_held_out_blocks_is_their_mean() -> None:
    is_covered = np.array([True, True, True, False])
    assert covered_share(is_covered, None) == 0.75
    assert covered_share(is_covered, np.array([4, 4, 4, 7])) == 0.5


def test_a_region_covers_blocks_as_often_as_their_mean() -> None:
    blocks = np.repeat([0, 1], [6, 2])
    row = coverage_row(TEST, 0.9, np.repeat([True, False], [6, 2]), 40, blocks, "joint, by block")
    assert (row["coverage"], row["guarantee"]) == (0.5, "joint, by block")


@pytest.mark.parametrize(("level", "promised"), [(0.47, True), (0.9, False)])
def test_divided_among_coordinates_each_counts_blocks(
    table: Path, outputs: StoredOutputs, level: float, promised: bool
) -> None:
    """Of K blocks of M rows each of three coordinates asks for the rank c (K + 1) M at its own level c, if there is."""
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    n_blocks = len(samples[VALIDATION]) // 2
    outputs.promise, outputs.levels = Promise(n_blocks, 2), [level]
    outputs.calibrated = np.arange(2 * n_blocks)
    rows = region_rows(outputs, samples, {"joint_bonferroni": REGION_METHODS["joint_bonferroni"]})
    row = next(row for row in rows if row["subset"] == TEST)
    single = 1 - (1 - level) / 3
    rank = int(np.ceil(single * (n_blocks + 1) * 2))
    assert (row["guarantee"] == "joint, at least, by block") is promised is (rank <= 2 * n_blocks)
    (_, errors) = next(moving_residuals(outputs, {subset: of.positions for subset, of in samples.items()}))
    sides = 2 * np.sort(np.abs(errors[VALIDATION]), axis=0)[min(rank, 2 * n_blocks) - 1]
    assert row["size_mm"] == pytest.approx(np.exp(np.log(sides).mean()))


def test_alarms_are_written(table: Path, outputs: StoredOutputs, tmp_path: Path) -> None:
    samples = {subset: read_subset(table, subset) for subset in SUBSETS}
    score_alarms(outputs, samples, dataset="arm", seed=0, output=tmp_path / "alarms.csv")
    alarms = pd.read_csv(tmp_path / "alarms.csv")
    assert len(alarms) == 2 * 2 * 5
    grown = alarms[(alarms["subset"] == "test") & (alarms["alpha"] == 0.1)].set_index("displacement_mm")
    assert grown.loc[10.0, "joint_alarm_rate"] > grown.loc[0.0, "joint_alarm_rate"]

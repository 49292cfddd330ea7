"""Typical poses: which rows they are, and what the figure says of them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.reporting.figures.reading import bounds
from softkin.reporting.figures.robot import QUANTILES, frame, plot, typical
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import N_MISSED, RUNS
from tests.unit.reporting.figures.drawn import bars


def spread_errors(results: DatasetResults) -> None:
    """Move the predictions of `test` of the deployed run so that row i is off by i + 1 mm in x of the last marker."""
    path = results.predictions[RUNS[3]]
    stored = pd.read_parquet(path)
    rows, name = stored["subset"] == "test", [name for name in stored if name.endswith("_x")][-1]
    stored.loc[rows, name] += np.arange(rows.sum()) * 1.0
    stored.to_parquet(path)


def test_poses_are_the_rows_nearest_to_quantiles_of_the_error() -> None:
    errors = np.random.default_rng(0).permutation(101).astype(float)
    pose, quantile = typical(errors)
    for number, level in enumerate(QUANTILES, 1):
        row = np.flatnonzero(pose == number).item()
        assert errors[row] == 100 * level
        assert quantile[row] == level
    assert (pose > 0).sum() == len(QUANTILES)
    assert np.isnan(quantile[pose == 0]).all()


def test_a_failed_row_is_no_typical_pose() -> None:
    errors = np.r_[np.linspace(1.0, 2.0, 99), 500.0]
    assert errors[typical(errors)[0] > 0].max() < 2.0


@pytest.mark.parametrize(("n_rows", "n_poses"), [(1, 1), (2, 2), (3, 3), (40, 4)])
def test_few_rows_have_fewer_poses_and_none_twice(n_rows: int, n_poses: int) -> None:
    pose, _ = typical(np.arange(n_rows, dtype=float))
    assert sorted(pose[pose > 0]) == list(range(1, n_poses + 1))


def test_each_row_of_test_has_its_error_and_its_intervals(results: DatasetResults) -> None:
    spread_errors(results)
    rows = frame(results)
    assert len(rows) == 40
    assert rows["is_shown"].all()
    shown = rows[rows["pose"] > 0].sort_values("pose")
    assert shown["pose"].tolist() == [1, 2, 3, 4]
    assert shown["error_quantile"].tolist() == list(QUANTILES)
    assert shown["error_mm"].is_monotonic_increasing
    box = bounds(results, "scp_spread", RUNS[3], 0.9)
    assert box is not None
    np.testing.assert_array_equal(rows[["lower_x", "lower_y", "lower_z"]], box[..., 0])
    np.testing.assert_allclose(rows["predicted_y"] - rows["true_y"], 1.0)
    np.testing.assert_allclose(rows["error_mm"], np.sqrt((np.arange(40) + 1.0) ** 2 + 2.0))


def test_of_many_markers_the_one_that_moves_furthest_decides(results_of_many_markers: DatasetResults) -> None:
    spread_errors(results_of_many_markers)
    rows = frame(results_of_many_markers)
    assert len(rows) == 3 * 40
    assert rows.loc[rows["is_shown"], "marker"].unique().tolist() == [3]
    assert (rows.groupby("pose").size()[[1, 2, 3, 4]] == 3).all()
    assert rows.loc[rows["marker"] == 1, "is_moving_x"].eq(False).all()
    figure = plot(rows, results_of_many_markers)
    assert "marker m3" in figure.get_suptitle()


def test_the_true_share_of_rows_stands_beside_the_poses(results: DatasetResults) -> None:
    figure = plot(frame(results), results)
    shares = figure.axes[1]
    assert shares.get_title(loc="left") == "share of all 40 rows covered"
    assert {right for _, right in bars(shares)} == {1 - N_MISSED / 40}


def test_without_a_deployed_model_there_is_nothing_to_draw(results: DatasetResults) -> None:
    choice = pd.read_csv(results.choice)
    choice[choice["interval_method"] == "cqr"].to_csv(results.choice, index=False)
    assert frame(results).empty

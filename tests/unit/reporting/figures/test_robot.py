"""Typical poses: which rows they are, and what the figure says of them."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.reporting.figures.reading import bounds
from softkin.reporting.figures.robot import NEAR, QUANTILES, frame, plot, typical
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


def test_poses_stand_near_quantiles_of_the_error_and_far_apart() -> None:
    rng = np.random.default_rng(0)
    ranks, positions = rng.permutation(101) / 100, rng.normal(size=(101, 3))
    numbers = typical(ranks, positions)
    assert sorted(numbers[numbers > 0]) == [1, 2, 3, 4]
    rows = [np.flatnonzero(numbers == number).item() for number in (1, 2, 3, 4)]
    for n, (row, level) in enumerate(zip(rows, QUANTILES, strict=True)):
        near = np.abs(ranks - level) <= NEAR
        assert near[row]
        others = positions[rows[:n]] if n else positions.mean(axis=0, keepdims=True)
        apart = np.linalg.norm(positions[:, None] - others[None], axis=-1).min(axis=1)
        assert apart[row] == apart[near].max()


def test_a_row_of_gross_error_is_no_typical_pose() -> None:
    positions = np.zeros((100, 3))
    positions[99] = 500.0  # the row of largest error lies far off, too
    numbers = typical(np.arange(100) / 99, positions)
    assert numbers[99] == 0


@pytest.mark.parametrize(("n_rows", "n_poses"), [(1, 1), (2, 2), (3, 3), (40, 4)])
def test_few_rows_have_fewer_poses_and_none_twice(n_rows: int, n_poses: int) -> None:
    ranks = np.arange(n_rows) / max(n_rows - 1, 1)
    numbers = typical(ranks, np.random.default_rng(1).normal(size=(n_rows, 3)))
    assert numbers[numbers > 0].tolist() == list(range(1, n_poses + 1))  # the ranks ascend


def test_each_row_of_test_has_its_error_and_its_intervals(results: DatasetResults) -> None:
    spread_errors(results)
    rows = frame(results)
    assert len(rows) == 40
    assert rows["is_shown"].all()
    shown = rows[rows["pose"] > 0].sort_values("pose")
    assert shown["pose"].tolist() == [1, 2, 3, 4]
    np.testing.assert_allclose(shown["error_rank"], QUANTILES, atol=NEAR)
    np.testing.assert_allclose(rows["error_rank"], np.arange(40) / 39)
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

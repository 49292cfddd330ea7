"""Typical poses: which rows they are, and what the figure says of them."""

from __future__ import annotations

import numpy as np
import pandas as pd

from softkin.core.samples import coordinate_columns
from softkin.reporting.figures.reading import bounds
from softkin.reporting.figures.robot import frame, plot
from softkin.reporting.figures.robot_panels import missed
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import N_MISSED, RUNS
from tests.unit.reporting.figures.drawn import bars


def test_each_row_of_test_has_its_error_and_its_intervals(results: DatasetResults) -> None:
    rows = frame(results)
    assert len(rows) == 40
    assert rows["is_shown"].all()
    box = bounds(results, "scp_spread", RUNS[3], 0.9, coordinate_columns(1))
    assert box is not None
    np.testing.assert_array_equal(rows[["lower_x", "lower_y", "lower_z"]], box[..., 0])
    np.testing.assert_allclose(rows["predicted_y"] - rows["true_y"], 1.0)
    np.testing.assert_allclose(rows["error_mm"], np.sqrt(3.0))


def test_as_many_poses_are_missed_as_of_all_rows(results: DatasetResults) -> None:
    rows = frame(results)
    is_missed = missed(rows).any(axis=1)
    shown = rows[rows["pose"] > 0].sort_values("pose")
    assert shown["pose"].tolist() == [1, 2, 3, 4]
    assert is_missed.mean() == N_MISSED / len(rows) == 0.25
    assert is_missed[shown.index].tolist() == [False, False, False, True]
    assert shown["error_rank"].is_monotonic_increasing


def test_of_many_markers_the_one_that_moves_furthest_decides(results_of_many_markers: DatasetResults) -> None:
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

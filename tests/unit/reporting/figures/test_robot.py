"""Poses in space."""

from __future__ import annotations

import numpy as np
import pytest

from softkin.reporting.figures.reading import bounds
from softkin.reporting.figures.robot import frame, plot
from softkin.reporting.figures.spec import DatasetResults


def test_four_poses_from_one_end_to_the_other_have_their_boxes(results: DatasetResults) -> None:
    rows = frame(results)
    assert len(rows) == 40
    shown = rows[rows["pose"] > 0].sort_values("pose")
    assert shown["pose"].tolist() == [1, 2, 3, 4]
    assert any(shown[f"true_{axis}"].is_monotonic_increasing for axis in "xy")
    box = bounds(results, "scp_spread", ("gp", "tuned"), 0.9)
    assert box is not None
    np.testing.assert_array_equal(rows[["lower_x", "lower_y", "lower_z"]], box[..., 0])
    np.testing.assert_allclose(rows["predicted_y"] - rows["true_y"], 1.0)


@pytest.mark.parametrize(("factor", "unit"), [(1.0, "mm"), (1e-3, "µm"), (1e-6, "nm")])
def test_what_is_seen_closely_is_told_in_a_fitting_unit(results: DatasetResults, factor: float, unit: str) -> None:
    rows = frame(results)
    for axis in "xyz":
        for name in ("true", "lower", "upper"):
            rows[f"{name}_{axis}"] = rows[f"predicted_{axis}"] + factor * (
                rows[f"{name}_{axis}"] - rows[f"predicted_{axis}"]
            )
    rows.loc[rows["pose"] == 4, "true_x"] = rows.loc[rows["pose"] == 4, "predicted_x"] + 20.0
    labels = [axes.get_xlabel() for axes in plot(rows, results).axes]
    assert labels == ["x (mm)", *[f"x ({unit})"] * 3, "x (mm)"]


def test_missed_poses_and_infinite_boxes_are_told(results: DatasetResults) -> None:
    rows = frame(results)
    rows[["lower_x", "lower_y", "lower_z"]] = -np.inf
    rows[["upper_x", "upper_y", "upper_z"]] = np.inf
    missed = rows["pose"] == 2
    rows.loc[missed, "lower_x"] = rows.loc[missed, "true_x"] + 1.0
    rows.loc[missed, "upper_x"] = rows.loc[missed, "true_x"] + 2.0
    titles = [axes.get_title() for axes in plot(rows, results).axes[1:]]
    assert titles == ["pose 1, covered", "pose 2, missed", "pose 3, covered", "pose 4, covered"]

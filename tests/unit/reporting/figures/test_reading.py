"""Readers that several figures share."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.core.runs import Run
from softkin.data.table import read_subset
from softkin.reporting.figures.reading import (
    Deployed,
    bounds,
    candidates,
    deployed,
    mean_marker_errors,
    predicted,
    shown_coordinate,
)
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import OFF_MM, RUNS


def test_the_deployed_run_is_that_of_the_best_candidate_around_a_point_model(results: DatasetResults) -> None:
    best = deployed(results)
    assert best == Deployed("gp", "tuned", "scp_spread", 0.9)
    assert best is not None
    assert best.run == RUNS[3]
    choice = pd.read_csv(results.choice)
    choice.iloc[[2, 1, 0]].to_csv(results.choice, index=False)
    assert deployed(results) == Deployed("gp", "tuned", "scp_mapie", 0.9)
    choice[choice["interval_method"] == "cqr"].to_csv(results.choice, index=False)
    assert candidates(results)["has_own_regressors"].all()
    assert deployed(results) is None


def test_predictions_are_of_the_coordinates_asked_for(results: DatasetResults) -> None:
    true = read_subset(results.table, "extrapolation").positions
    guess = predicted(results, RUNS[1], "extrapolation", ["m1_z", "m1_x"])
    np.testing.assert_allclose(guess - true[:, [2, 0]], 3 * OFF_MM[RUNS[1]])


def test_the_error_is_the_distance_of_a_marker_averaged_over_moving_ones(
    results: DatasetResults, results_of_many_markers: DatasetResults
) -> None:
    np.testing.assert_allclose(mean_marker_errors(results, RUNS[0], "test"), np.sqrt(3) * OFF_MM[RUNS[0]])
    path = results_of_many_markers.predictions[RUNS[0]]
    stored = pd.read_parquet(path)
    stored["m1_x"] += 1000.0
    stored["m2_x"] += 1000.0
    stored.to_parquet(path)
    errors = mean_marker_errors(results_of_many_markers, RUNS[0], "test")
    off = OFF_MM[RUNS[0]]
    np.testing.assert_allclose(errors, (np.hypot(1000.0 + off, np.sqrt(2) * off) + np.sqrt(3) * off) / 2)


def test_the_coordinate_that_moves_furthest_is_shown(
    results: DatasetResults, results_of_many_markers: DatasetResults
) -> None:
    assert shown_coordinate(results)[1] in ("m1_x", "m1_y")
    place, name = shown_coordinate(results_of_many_markers)
    assert (place, name) in ((6, "m3_x"), (7, "m3_y"))


@pytest.mark.parametrize(("preset", "is_there"), [("tuned", True), ("paper", False)])
def test_bounds_of_a_run_without_intervals_are_none(results: DatasetResults, preset: str, is_there: bool) -> None:
    stored = bounds(results, "scp_mapie", Run("gp", preset), 0.9, ["m1_z", "m1_x"])
    assert (stored is not None) == is_there
    if stored is not None:
        frame = pd.read_parquet(results.intervals["scp_mapie"])
        rows = frame[(frame["model"] == "gp") & (frame["subset"] == "test")]
        expected = [[rows[f"{side}_{name}"] for side in ("lower", "upper")] for name in ("m1_z", "m1_x")]
        np.testing.assert_array_equal(stored, np.transpose(expected, (2, 0, 1)))

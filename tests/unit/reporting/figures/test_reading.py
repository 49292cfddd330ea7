"""What several figures read."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.reporting.figures.reading import Chosen, bounds, candidates, chosen, mean_marker_errors, shown_coordinate
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import OFF_MM


def test_the_chosen_model_is_the_one_that_candidates_surround(results: DatasetResults) -> None:
    assert chosen(results) == Chosen("gp", "tuned", "scp_spread", 0.9)
    choice = pd.read_csv(results.choice)
    choice[choice["interval_method"] == "cqr"].to_csv(results.choice, index=False)
    assert candidates(results)["on_quantiles"].all()
    assert chosen(results) is None


def test_the_error_is_the_distance_of_a_marker(results: DatasetResults) -> None:
    errors = mean_marker_errors(results, ("gb", "paper"), "test")
    np.testing.assert_allclose(errors, np.sqrt(3) * OFF_MM["gb", "paper"])
    assert shown_coordinate(results)[1] in ("m1_x", "m1_y")


@pytest.mark.parametrize(("preset", "is_there"), [("tuned", True), ("paper", False)])
def test_bounds_of_a_run_that_has_none_are_none(results: DatasetResults, preset: str, is_there: bool) -> None:
    found = bounds(results, "scp_mapie", ("gp", preset), 0.9)
    assert (found is not None) == is_there
    if found is not None:
        assert found.shape == (40, 3, 2)

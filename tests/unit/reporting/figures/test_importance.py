"""Which parameters mattered."""

from __future__ import annotations

from softkin.reporting.figures.importance import frame
from softkin.reporting.figures.spec import DatasetResults


def test_the_parameter_that_decides_comes_first_and_short_studies_are_left_out(results: DatasetResults) -> None:
    rows = frame(results)
    assert set(rows["model"]) == {"gb"}  # gp has nine trials
    assert rows["parameter"].iloc[0] == "rate"
    assert set(rows["parameter"]) == {"rate", "kind", "depth"}  # one never changed
    assert rows["importance"].iloc[0] > 5 * rows["importance"].iloc[1]
    assert set(rows["n_trials"]) == {30}  # those that were cut short among them

"""Ranking of models."""

from __future__ import annotations

import pandas as pd
import pytest

from softkin.reporting.figures.ranking import frame
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.style import LOOKS
from tests.unit.reporting.figures.conftest import OFF_MM, RUNS


def test_each_run_has_its_errors_and_one_is_chosen(results: DatasetResults) -> None:
    rows = frame(results).set_index(["model", "preset"])
    assert set(rows.index) == set(RUNS)
    for run in RUNS:
        assert rows.loc[run, "test"] == pytest.approx(3**0.5 * OFF_MM[run])
        assert rows.loc[run, "extrapolation"] == pytest.approx(3 * 3**0.5 * OFF_MM[run])
    assert rows.index[rows["chosen"]].tolist() == [("gp", "tuned")]


def test_an_error_of_zero_is_drawn_too(results: DatasetResults) -> None:
    from softkin.reporting.figures.ranking import plot

    rows = frame(results)
    rows.loc[0, "test"] = 0.0
    axes = plot(rows, results).axes[0]
    marks = [line for line in axes.lines if line.get_marker() == LOOKS[rows.loc[0, "model"]][1]]
    assert pd.Series([line.get_xdata()[0] for line in marks]).min() == 1e-9

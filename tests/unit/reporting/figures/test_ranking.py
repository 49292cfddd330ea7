"""Ranking of models."""

from __future__ import annotations

import pytest

from softkin.reporting.figures.ranking import frame, plot
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.style import LEAST_MM, LOOKS
from tests.unit.reporting.figures.conftest import OFF_MM, RUNS
from tests.unit.reporting.figures.drawn import xs


def test_each_run_has_its_errors_and_one_is_deployed(results: DatasetResults) -> None:
    rows = frame(results).set_index(["model", "preset"])
    assert set(rows.index) == set(RUNS)
    for run in RUNS:
        assert rows.loc[run, "test"] == pytest.approx(3**0.5 * OFF_MM[run])
        assert rows.loc[run, "extrapolation"] == pytest.approx(3 * 3**0.5 * OFF_MM[run])
    assert rows.index[rows["chosen"]].tolist() == [("gp", "tuned")]


def test_a_ring_marks_the_deployed_run_and_an_open_mark_the_papers_settings(results: DatasetResults) -> None:
    rows = frame(results)
    axes = plot(rows, results).axes[0]
    ring = next(line for line in axes.lines if line.get_markersize() == 14)
    assert xs(ring)[0] == rows.loc[rows["chosen"], "test"].item()
    opened = {xs(line)[0] for line in axes.lines if line.get_markerfacecolor() == "white"}
    assert opened == set(rows.loc[rows["preset"] == "paper", "test"])


def test_an_error_of_zero_is_drawn_too(results: DatasetResults) -> None:
    rows = frame(results)
    rows.loc[0, "test"] = 0.0
    axes = plot(rows, results).axes[0]
    marks = [line for line in axes.lines if line.get_marker() == LOOKS[rows.loc[0, "model"]][1]]
    assert min(xs(line)[0] for line in marks) == LEAST_MM

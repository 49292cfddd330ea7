"""Target spaces, as a figure."""

from __future__ import annotations

from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.target_spaces import frame, plot
from tests.unit.reporting.figures.drawn import marks, xs


def test_each_model_has_its_errors_on_extrapolation_in_either_space(results: DatasetResults) -> None:
    rows = frame(results).set_index(["model", "target_space"])
    assert rows["rmse_mm"].to_dict() == {
        ("gb", "cartesian"): 6.0,
        ("gb", "curvature"): 3.0,
        ("gp", "cartesian"): 6.0,
        ("gp", "curvature"): 3.0,
    }
    assert rows["is_chosen"].tolist() == [True, False, False, True]


def test_an_open_mark_is_a_model_of_positions_and_a_ring_the_chosen_space(results: DatasetResults) -> None:
    panel = plot(frame(results), results).axes[0]
    rings = {xs(mark)[0] for mark in marks(panel) if mark.get_markersize() == 11}
    opened = {xs(mark)[0] for mark in marks(panel) if mark.get_markerfacecolor() == "white"}
    assert (rings, opened) == ({6.0, 3.0}, {6.0})
    assert [text.get_text() for text in panel.get_yticklabels()] == ["Gaussian process", "Gradient boosting"]

"""The specification of a figure."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure

from softkin.reporting.figures.drawing import draw
from softkin.reporting.figures.spec import CampaignResults, DatasetResults, FigureSpec
from softkin.reporting.figures.style import panels


def _frame(results: CampaignResults) -> pd.DataFrame:
    return pd.DataFrame({"model": ["gp"], "preset": ["tuned"], "interval_method": [""], "n": len(results.model_titles)})


def _plot(frame: pd.DataFrame, results: CampaignResults) -> Figure:
    figure, [[axes]] = panels(1, 1, 4.0, 3.0)
    axes.plot(frame["n"], frame["n"], "o", label=results.model_titles["gp"])
    return figure


def test_a_new_figure_needs_a_frame_and_a_plot_and_nothing_else(tmp_path: Path) -> None:
    spec: FigureSpec[CampaignResults] = FigureSpec("size", "Size", "How many models there are.", _frame, _plot)
    draw({spec.name: spec}, CampaignResults(tmp_path, {}, {"gp": "Gaussian process"}), tmp_path / "figures")
    index = pd.read_csv(tmp_path / "figures" / "index.csv", keep_default_na=False)
    expected = ["size", "Size", "How many models there are.", "gp", "tuned", ""]
    assert index.iloc[0].tolist() == expected
    assert {path.name for path in (tmp_path / "figures").iterdir()} == {"index.csv", "size.csv", "size.png", "size.svg"}


def test_specifications_and_results_cannot_be_changed(results: DatasetResults) -> None:
    spec: FigureSpec[CampaignResults] = FigureSpec("size", "Size", "How many models there are.", _frame, _plot)
    with pytest.raises(dataclasses.FrozenInstanceError):
        spec.name = "other"  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        results.title = "other"  # type: ignore[misc]

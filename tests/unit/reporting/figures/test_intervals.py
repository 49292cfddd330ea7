"""The paper's Figure 6."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from softkin.reporting.figures.intervals import DEPLOYED_MODEL, PAPER_RECIPE, frame, plot
from softkin.reporting.figures.spec import DatasetResults
from tests.unit.reporting.figures.conftest import N_MISSED
from tests.unit.reporting.figures.drawn import xs


def test_the_papers_figure_has_its_four_methods_sorted_rows_and_misses(results: DatasetResults) -> None:
    shown = PAPER_RECIPE.frame(results)
    assert shown["interval_method"].unique().tolist() == ["qr", "cqr", "scp_mapie", "scp_crepes"]
    assert set(shown["model"]) == {"gb"}
    assert set(shown["preset"]) == {"paper"}
    for _, rows in shown.groupby("interval_method"):
        assert rows["true"].is_monotonic_increasing
        assert (~rows["covered"]).sum() == N_MISSED


def test_quantile_regressors_keep_the_papers_model_around_the_deployed_one(results: DatasetResults) -> None:
    shown = DEPLOYED_MODEL.frame(results).drop_duplicates("interval_method").set_index("interval_method")
    assert shown.loc[["qr", "scp_mapie"], "model"].tolist() == ["gb", "gp"]
    assert set(shown["preset"]) == {"tuned"}


def test_without_a_deployed_model_only_the_papers_figure_is_drawn(results: DatasetResults) -> None:
    choice = pd.read_csv(results.choice)
    choice[choice["interval_method"] == "cqr"].to_csv(results.choice, index=False)
    assert frame(results, is_papers=False).empty
    assert not frame(results, is_papers=True).empty


def test_below_each_panel_stand_the_same_rows_relative_to_the_true_position(results: DatasetResults) -> None:
    shown = PAPER_RECIPE.frame(results)
    axes = plot(shown, results).axes
    above, below = axes[0], axes[4]
    assert len(xs(above.lines[1])) == N_MISSED  # the missed ones
    np.testing.assert_array_equal(below.lines[0].get_ydata(), 0.0)
    assert "covers 75.0%" in above.get_title()
    width = (shown["upper"] - shown["lower"])[shown["interval_method"] == "qr"].mean()
    assert float(above.get_title().split("width ")[1].removesuffix(" mm")) == pytest.approx(width, rel=5e-3)

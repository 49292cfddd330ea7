"""Map of command space."""

from __future__ import annotations

import numpy as np

from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.workspace import frame, plot, shown_commands


def test_errors_stand_beside_their_commands(results: DatasetResults) -> None:
    rows = frame(results)
    assert rows.groupby("subset").size().to_dict() == {"train": 40, "test": 40, "extrapolation": 40}
    assert rows.loc[rows["subset"] == "train", "error_mm"].isna().all()
    np.testing.assert_allclose(rows.loc[rows["subset"] == "extrapolation", "error_mm"], 3 * 3**0.5)
    assert shown_commands(rows) == ["u1", "u2"]


def test_any_number_of_commands_can_be_drawn(results: DatasetResults) -> None:
    rows = frame(results)
    rng = np.random.default_rng(0)
    many = rows.assign(**{f"u{i}": rng.uniform(size=len(rows)) for i in range(3, 8)})
    many["error_mm"] = np.where(many["subset"] == "train", np.nan, many["u5"] + 0.1)
    assert "u5" in shown_commands(many)
    assert len(shown_commands(many)) == 4
    assert len(plot(many, results).axes) == 6 + 1  # pairs, and the scale of colours
    one = plot(rows.drop(columns="u2"), results).axes
    assert one[0].get_ylabel() == "mean marker error (mm)"

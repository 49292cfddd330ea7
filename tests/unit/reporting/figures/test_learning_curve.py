"""Errors by the share of train."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from softkin.reporting.figures.learning_curve import frame, plot
from softkin.reporting.figures.spec import CampaignResults
from tests.unit.reporting.figures.drawn import xs, ys


def results(folder: Path, path: Path | None) -> CampaignResults:
    titles = {"svr": "Support vectors", "mlp": "Perceptron"}
    return CampaignResults(folder / "none.csv", {"arm": "ARM (made up)", "leg": "LEG"}, titles, path)


def test_each_model_has_its_line_in_the_panel_of_preset_and_dataset(tmp_path: Path) -> None:
    rows = [
        {"dataset": dataset, "model": model, "preset": preset, "share": share, "n_rows": 10, "rmse_mm": error / share}
        | {"leak": dataset == "leg"}
        for dataset in ("arm", "leg")
        for preset in ("paper", "tuned")
        for model, error in (("svr", 1.0), ("mlp", 2.0))
        for share in (0.1, 1.0)
    ]
    pd.DataFrame(rows).to_csv(tmp_path / "curves.csv", index=False)
    campaign = results(tmp_path, tmp_path / "curves.csv")
    table = frame(campaign)
    assert len(table) == len(rows)
    panels = plot(table, campaign).axes
    assert [panel.get_title() for panel in panels] == [
        "ARM\npaper",
        "LEG (leak)\npaper",
        "ARM\ntuned",
        "LEG (leak)\ntuned",
    ]
    svr, mlp = panels[0].lines
    assert xs(svr) == [0.1, 1.0]
    assert ys(svr) == [10.0, 1.0]
    assert ys(mlp) == [20.0, 2.0]


def test_without_curves_nothing_is_drawn(tmp_path: Path) -> None:
    assert frame(results(tmp_path, None)).empty


def test_errors_are_headed_by_the_unit_of_the_robot(tmp_path: Path) -> None:
    row = {"dataset": "arm", "model": "svr", "preset": "paper", "n_rows": 10, "rmse_mm": 1.0, "leak": False}
    for unit, headed in ((None, "mm"), ("px", "px")):
        own = {} if unit is None else {"unit": unit}
        pd.DataFrame([{**row, **own, "share": share} for share in (0.5, 1.0)]).to_csv(tmp_path / "c.csv", index=False)
        campaign = results(tmp_path, tmp_path / "c.csv")
        assert plot(frame(campaign), campaign).axes[0].get_ylabel() == f"RMSE on test ({headed})"

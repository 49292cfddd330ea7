"""Drawing of figures into files."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from PIL import Image

from softkin.reporting.figures import FIGURES
from softkin.reporting.figures.drawing import RUN_COLUMNS, draw
from softkin.reporting.figures.rendering import DPI
from softkin.reporting.figures.spec import DatasetResults
from softkin.reporting.figures.style import PAGE
from tests.unit.reporting.figures.conftest import RUNS


def test_a_figure_is_a_picture_a_drawing_and_the_numbers_behind_it(results: DatasetResults, tmp_path: Path) -> None:
    """Every figure of the registries is drawn in tests/contract/test_figures.py."""
    drawn = {name: FIGURES[name] for name in ("ranking", "intervals_paper")}
    draw(drawn, results, tmp_path / "figures")
    index = pd.read_csv(tmp_path / "figures" / "index.csv", keep_default_na=False)
    assert index["figure"].unique().tolist() == list(drawn)
    for name, spec in drawn.items():
        rows = index[index["figure"] == name]
        assert (set(rows["title"]), set(rows["caption"])) == ({spec.title}, {spec.caption})
        frame = spec.frame(results)
        runs = frame[RUN_COLUMNS].drop_duplicates()
        assert rows[RUN_COLUMNS].to_numpy().tolist() == runs.to_numpy().tolist()
        assert len(pd.read_csv(tmp_path / "figures" / f"{name}.csv")) == len(frame)
        assert "<svg" in (tmp_path / "figures" / f"{name}.svg").read_text()[:2000]
        with Image.open(tmp_path / "figures" / f"{name}.png") as image:
            assert image.width == PAGE * DPI
            assert image.mode == "P"  # 256 colours


def test_a_figure_of_what_was_not_run_is_left_out_and_logged(
    results: DatasetResults, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO", logger="softkin")
    for method, path in results.intervals.items():
        stored = pd.read_parquet(path)
        stored[stored["model"] == "gp"].to_parquet(path)
        assert method
    draw({"intervals_paper": FIGURES["intervals_paper"]}, results, tmp_path / "figures")
    assert "no figure intervals_paper: what it shows was not run, or too little of it" in caplog.text
    assert len(pd.read_csv(tmp_path / "figures" / "index.csv")) == 0


def test_pictures_do_not_change_when_their_numbers_do_not(results: DatasetResults, tmp_path: Path) -> None:
    one = {"conditional_coverage": FIGURES["conditional_coverage"]}
    for place in ("a", "b"):
        draw(one, results, tmp_path / place)
    for ending in ("png", "svg", "csv"):
        first, second = ((tmp_path / place / f"conditional_coverage.{ending}").read_bytes() for place in ("a", "b"))
        assert first == second


@pytest.mark.parametrize(
    ("without", "gone"),
    [
        ({"trials": {}}, {"tuning_history", "importance"}),
        ({"intervals": ["qr", "cqr"], "choice": ["cqr"]}, {"residuals", "robot", "workspace", "intervals_deployed"}),
        ({"runs": [RUNS[3]], "choice": ["scp_spread"]}, {"intervals_paper"}),
    ],
)
def test_a_smaller_configuration_leaves_out_its_figures_and_no_others(
    results: DatasetResults, without: dict[str, Any], gone: set[str]
) -> None:
    """Only cqr and qr; nothing tuned; only one model: everything else is still drawn."""
    kept = without.get("intervals", list(results.intervals))
    runs = without.get("runs", list(results.predictions))
    smaller = dataclasses.replace(
        results,
        trials=without.get("trials", results.trials),
        intervals={method: results.intervals[method] for method in kept},
        predictions={run: results.predictions[run] for run in runs},
    )
    choice = pd.read_csv(results.choice)
    choice = choice[choice["interval_method"].isin(without.get("choice", list(kept)))]
    choice[choice["interval_method"].isin(kept)].to_csv(results.choice, index=False)
    for path in results.intervals.values():
        stored = pd.read_parquet(path)
        stored[[run in runs for run in zip(stored["model"], stored["preset"], strict=True)]].to_parquet(path)
    for path in (results.point, results.interval_metrics, results.conditional):
        stored = pd.read_csv(path)
        stored[[run in runs for run in zip(stored["model"], stored["preset"], strict=True)]].to_csv(path, index=False)
    frames = {name: spec.frame(smaller) for name, spec in FIGURES.items()}
    gone = gone | {"time"}  # the robot is not recorded
    assert {name for name, frame in frames.items() if frame.empty} == gone
    for name, spec in FIGURES.items():
        if name not in gone:
            assert spec.plot(frames[name], smaller).axes

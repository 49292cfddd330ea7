"""Every figure of the registry, drawn from made-up results of one dataset."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from softkin.bounds import bounds_frame
from softkin.conditional_coverage import conditional_coverage
from softkin.datasets.table import read_subset
from softkin.figures import FIGURES
from softkin.figures.drawing import draw
from softkin.interface import DatasetResults
from softkin.intervals import INTERVAL_METHODS

METHODS = ("qr", "cqr", "scp_mapie", "scp_crepes", "scp_spread")


@pytest.fixture
def results(table: Path, tmp_path: Path) -> DatasetResults:
    """Two mm around the truth, but for the first ten rows, which are missed."""
    rng = np.random.default_rng(0)
    for method in METHODS:
        frames = []
        for model, preset in (("gb", "paper"), ("gb", "tuned"), ("gp", "tuned")):
            for subset in ("test", "extrapolation"):
                centre = read_subset(table, subset).positions
                centre[:10] += 9.0
                half = rng.uniform(1.0, 3.0, centre.shape)
                frame = bounds_frame(np.stack([centre - half, centre + half], axis=-1), subset, 0.9)
                frames.append(frame.assign(model=model, preset=preset))
        pd.concat(frames).to_parquet(tmp_path / f"{method}.parquet")
    rows = [("gp", "tuned", "scp_spread", 1.0), ("gp", "tuned", "scp_mapie", 2.0), ("gb", "tuned", "cqr", 3.0)]
    choice = pd.DataFrame(rows, columns=["model", "preset", "interval_method", "cv_winkler_mm"])
    choice.assign(confidence_level=0.9, chosen=[True, False, False]).to_csv(tmp_path / "choice.csv", index=False)
    intervals = {method: tmp_path / f"{method}.parquet" for method in METHODS}
    conditional_coverage(
        table,
        dataset="arm",
        intervals=intervals,
        shown={("gp", "tuned"), ("gb", "paper"), ("gb", "tuned")},
        confidence_levels=[0.9],
        seed=0,
        output=tmp_path / "conditional.csv",
    )
    return DatasetResults(
        dataset="arm",
        title="ARM",
        table=table,
        intervals=intervals,
        choice=tmp_path / "choice.csv",
        conditional=tmp_path / "conditional.csv",
        method_titles={name: method.title for name, method in INTERVAL_METHODS.items()},
        on_quantiles={name: method.on == "quantiles" for name, method in INTERVAL_METHODS.items()},
    )


def test_every_figure_is_drawn_with_the_numbers_behind_it(results: DatasetResults, tmp_path: Path) -> None:
    draw(FIGURES, results, tmp_path / "figures")
    index = pd.read_csv(tmp_path / "figures" / "index.csv")
    assert set(index["figure"]) == set(FIGURES)
    for name in FIGURES:
        with Image.open(tmp_path / "figures" / f"{name}.png") as image:
            assert image.width > 1000
            assert len(set(image.convert("L").resize((64, 32)).tobytes())) > 8  # not a blank page
        assert "<svg" in (tmp_path / "figures" / f"{name}.svg").read_text()[:2000]
        assert len(pd.read_csv(tmp_path / "figures" / f"{name}.csv")) > 10


def test_the_papers_figure_has_its_four_methods_sorted_rows_and_misses(results: DatasetResults) -> None:
    frame = FIGURES["intervals_paper"].frame(results)
    assert frame["interval_method"].unique().tolist() == ["qr", "cqr", "scp_mapie", "scp_crepes"]
    assert set(frame["model"]) == {"gb"}
    for _, rows in frame.groupby("interval_method"):
        assert rows["true"].is_monotonic_increasing
        assert (~rows["covered"]).sum() == 10
    chosen = FIGURES["intervals_chosen"].frame(results).drop_duplicates("interval_method").set_index("interval_method")
    assert chosen.loc[["qr", "scp_mapie"], "model"].tolist() == ["gb", "gp"]
    assert set(chosen["preset"]) == {"tuned"}


def test_a_figure_of_what_was_not_run_is_left_out_and_said_so(
    results: DatasetResults, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO", logger="softkin")
    for method, path in results.intervals.items():
        stored = pd.read_parquet(path)
        stored[stored["model"] == "gp"].to_parquet(path)
        assert method
    draw({"intervals_paper": FIGURES["intervals_paper"]}, results, tmp_path / "figures")
    assert "no intervals_paper: nothing of it was run" in caplog.text
    assert len(pd.read_csv(tmp_path / "figures" / "index.csv")) == 0


def test_pictures_do_not_change_when_their_numbers_do_not(results: DatasetResults, tmp_path: Path) -> None:
    one = {"conditional_coverage": FIGURES["conditional_coverage"]}
    for place in ("a", "b"):
        draw(one, results, tmp_path / place)
    for ending in ("png", "svg", "csv"):
        first, second = ((tmp_path / place / f"conditional_coverage.{ending}").read_bytes() for place in ("a", "b"))
        assert first == second


@pytest.mark.parametrize("name", FIGURES)
def test_it_is_registered_under_its_own_name(name: str) -> None:
    assert FIGURES[name].name == name

"""What every figure must do: those of one dataset and those across datasets."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from softkin.core.files import sha256_of
from softkin.core.samples import SUBSETS
from softkin.data.table import to_table, write_table
from softkin.reporting.figures import CAMPAIGN_FIGURES, FIGURES
from softkin.reporting.figures.drawing import RUN_COLUMNS, draw
from softkin.reporting.figures.rendering import DPI
from softkin.reporting.figures.spec import CampaignResults, DatasetResults, FigureSpec
from softkin.reporting.figures.style import PAGE
from tests.conftest import four_subsets
from tests.contract import laws
from tests.recorded_robot import with_recording
from tests.unit.reporting.figures.conftest import results_in, write_results

Results = DatasetResults | CampaignResults
Spec = FigureSpec[Any]


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> DatasetResults:
    folder = tmp_path_factory.mktemp("results")
    write_table(to_table(with_recording(four_subsets(dict.fromkeys(SUBSETS, 40)))), folder / "table.parquet")
    write_results(folder)
    return replace(results_in(folder), unit="px")


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> CampaignResults:
    """Two models, two metrics, two subsets; each cell reproduced, and tuned better."""
    rows = [
        {"dataset": "arm", "subset": subset, "model": model, "metric": metric, "printed": "2.0", "note": ""}
        | {"paper_value": 2.0, "paper_verdict": "reproduced", "tuned_value": 1.0, "tuned_verdict": "better"}
        for model in ("gb", "gp")
        for subset in ("test", "extrapolation")
        for metric in ("rmse_mm", "mae_mm")
    ]
    path = tmp_path_factory.mktemp("campaign") / "comparison.csv"
    pd.DataFrame(rows).to_csv(path, index=False)
    curves = [
        {"dataset": "arm", "model": model, "preset": preset, "share": share, "n_rows": 100 * share}
        | {"rmse_mm": (2.0 if model == "gp" else 1.0) / share, "leak": False}
        for model in ("gb", "gp")
        for preset in ("paper", "tuned")
        for share in (0.05, 0.25, 1.0)
    ]
    pd.DataFrame(curves).to_csv(path.with_name("curves.csv"), index=False)
    titles = {"gb": "Gradient boosting", "gp": "Gaussian process"}
    return CampaignResults(path, {"arm": "ARM"}, titles, path.with_name("curves.csv"))


def files_of(results: Results) -> list[Path]:
    folder = (results.table if isinstance(results, DatasetResults) else results.published_comparison).parent
    return sorted(path for path in folder.iterdir() if path.is_file())


def is_named_and_explained(name: str, spec: Spec, _results: Results, _folder: Path) -> None:
    laws.has_name_and_title(name, spec)
    assert spec.caption.endswith(".")


def has_a_frame_that_names_its_runs(_name: str, spec: Spec, results: Results, _folder: Path) -> None:
    frame = spec.frame(results)
    assert len(frame) >= 3
    assert set(RUN_COLUMNS) <= set(frame.columns)
    assert frame[RUN_COLUMNS].notna().all(axis=None)


def repeats_itself_and_changes_nothing(_name: str, spec: Spec, results: Results, _folder: Path) -> None:
    """Neither the results, nor the frame that it is drawn from, nor matplotlib's settings; lengths are in its unit."""
    files, settings = files_of(results), dict(mpl.rcParams)
    before = sha256_of(files)
    with laws.global_random_states_kept():
        frame, again = (spec.frame(results) for _ in range(2))
        pd.testing.assert_frame_equal(frame, again)
        figure = spec.plot(frame, results)
    assert isinstance(results, CampaignResults) or not says_millimetres(figure)
    pd.testing.assert_frame_equal(frame, again)
    assert (files_of(results), sha256_of(files)) == (files, before)
    assert dict(mpl.rcParams) == settings


def says_millimetres(figure: Figure) -> list[str]:
    """The texts of a figure that have the word."""
    texts = [text.get_text() for text in figure.findobj(Text)]
    return [text for text in texts if re.search(r"\bmm\b", text)]


def is_drawn_within_a_page(name: str, spec: Spec, results: Results, folder: Path) -> None:
    """Not blank, nothing cut off, no wider than its text can bear, of a size that a page can hold."""
    draw({name: spec}, results, folder)
    with Image.open(folder / f"{name}.png") as image:
        grey = image.convert("L")
    assert 1000 < grey.width <= PAGE * DPI
    assert len(set(grey.resize((64, 32)).tobytes())) > 8
    edges = np.asarray(grey).astype(int)
    assert min(edges[0].min(), edges[-1].min(), edges[:, 0].min(), edges[:, -1].min()) > 250
    assert (folder / f"{name}.png").stat().st_size < 300_000


LAWS = (
    is_named_and_explained,
    has_a_frame_that_names_its_runs,
    repeats_itself_and_changes_nothing,
    is_drawn_within_a_page,
)


def check_figure(name: str, spec: Spec, results: Results, folder: Path) -> None:
    for law in LAWS:
        law(name, spec, results, folder)


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_of_a_dataset_keeps_the_contract(name: str, results: DatasetResults, tmp_path: Path) -> None:
    check_figure(name, FIGURES[name], results, tmp_path)


@pytest.mark.parametrize("name", CAMPAIGN_FIGURES)
def test_every_figure_across_datasets_keeps_the_contract(name: str, campaign: CampaignResults, tmp_path: Path) -> None:
    check_figure(name, CAMPAIGN_FIGURES[name], campaign, tmp_path)


RANKING = FIGURES["ranking"]


def of_changed_frame(change: Callable[[pd.DataFrame], pd.DataFrame]) -> dict[str, Any]:
    return {"frame": lambda results: change(RANKING.frame(results))}


def blank(_frame: pd.DataFrame, _results: DatasetResults) -> Figure:
    return Figure(figsize=(PAGE, 3))


def too_wide(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    figure = RANKING.plot(frame, results)
    figure.set_size_inches(2 * PAGE, 3)
    return figure


def in_millimetres(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    return RANKING.plot(frame, replace(results, unit="mm"))


def eating_its_frame(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    figure = RANKING.plot(frame, results)
    frame["model"] = ""
    return figure


def of_its_own_font(frame: pd.DataFrame, results: DatasetResults) -> Figure:
    mpl.rcParams["font.size"] = 7.0
    return RANKING.plot(frame, results)


@pytest.mark.parametrize(
    ("law", "fault"),
    [
        (is_named_and_explained, {"name": "scores"}),
        (is_named_and_explained, {"caption": ""}),
        (has_a_frame_that_names_its_runs, of_changed_frame(lambda frame: frame.iloc[:0])),
        (has_a_frame_that_names_its_runs, of_changed_frame(lambda frame: frame.drop(columns="model"))),
        (repeats_itself_and_changes_nothing, of_changed_frame(lambda frame: frame.sample(frac=1.0, axis=1))),
        (repeats_itself_and_changes_nothing, {"plot": in_millimetres}),
        (repeats_itself_and_changes_nothing, {"plot": eating_its_frame}),
        (repeats_itself_and_changes_nothing, {"plot": of_its_own_font}),
        (is_drawn_within_a_page, {"plot": blank}),
        (is_drawn_within_a_page, {"plot": too_wide}),
    ],
)
def test_the_contract_is_broken_by(
    law: Callable[..., None], fault: dict[str, Any], results: DatasetResults, tmp_path: Path
) -> None:
    assert law in LAWS
    with mpl.rc_context(), pytest.raises(AssertionError):
        law("ranking", replace(RANKING, **fault), results, tmp_path)

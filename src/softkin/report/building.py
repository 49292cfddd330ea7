"""Write results/report.html: gather the results, lay them out, render the page."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from pandas.errors import EmptyDataError

from softkin.files import read_json, write_text
from softkin.interface import SUBSETS, SoftkinError
from softkin.report import published
from softkin.report.cards import card_page
from softkin.report.grid import Grid, share_text
from softkin.report.headline import robot_cards
from softkin.report.images import pictures
from softkin.report.jobs import Job, duration, measured, slowest_grid
from softkin.report.marks import Marks, kinds
from softkin.report.outside import outside_grid, searched_grid, spaces_grid
from softkin.report.provenance import citations, commit, data_grid, settings, versions
from softkin.report.scores import choice_grid, interval_grid, point_grid
from softkin.tables.published import summary

logger = logging.getLogger("softkin")

#: Stands for no dataset: names of datasets have no space.
ALL_ROBOTS = "all robots"
MAX_BYTES = 10_000_000


def build_report(
    *,
    tables: Sequence[str | Path],
    descriptions: Mapping[str, str | Path],
    data_cards: Mapping[str, str | Path],
    card_pages: Mapping[str, str | Path],
    figures: Mapping[str, str | Path],
    campaign_figures: str | Path,
    jobs: Sequence[Job],
    config: Mapping[str, Any],
    model_titles: Mapping[str, str],
    interval_titles: Mapping[str, str],
    citation: str | Path,
    report: str | Path,
) -> None:
    """Write the page `report`, beside which the folders of `figures` lie.

    `tables` are files of results/tables; `descriptions`, `data_cards` (JSON), `card_pages` (Markdown; both may be
    empty) and `figures` (folders) are by dataset, `campaign_figures` is the folder of those across datasets; `config`
    is the whole checked configuration; `citation` is CITATION.cff at the top of the checkout whose commit is told.

    Raises:
        SoftkinError: the page would be larger than 10 MB.
    """
    frames = {Path(path).stem: _read(Path(path)) for path in tables}
    abouts = {dataset: read_json(path) for dataset, path in descriptions.items()}
    cards = {dataset: read_json(path) for dataset, path in data_cards.items()}
    sources = {dataset: config["sources"][dataset] for dataset in descriptions}
    marks = Marks(sources, abouts, cards)
    times = measured(jobs)
    titles = {ALL_ROBOTS: "All robots"} | {dataset: about["title"] for dataset, about in abouts.items()}
    folders = {ALL_ROBOTS: Path(campaign_figures)} | {dataset: Path(folder) for dataset, folder in figures.items()}
    page = (
        _environment()
        .get_template("page.html.j2")
        .render(
            campaign=config["campaign"],
            seed=config["seed"],
            written=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
            commit=commit(Path(citation).parent),
            versions=versions(),
            duration=duration(times),
            settings=settings(config),
            citations=citations(Path(citation), sources),
            robots=robot_cards(frames, abouts, model_titles, interval_titles, marks),
            verdicts=_verdicts(frames),
            data=data_grid(abouts, sources, marks),
            data_cards=cards,
            card_pages={dataset: card_page(path) for dataset, path in card_pages.items()},
            scores=_scores(frames, model_titles, interval_titles, marks),
            published=_published(frames, model_titles, interval_titles, marks),
            slowest=slowest_grid(times, model_titles),
            pictures=pictures(folders, titles, Path(report).parent),
            titles=titles,
            all_robots=ALL_ROBOTS,
            marks=marks,
            subsets=SUBSETS,
        )
    )
    size = len(page.encode())
    if size > MAX_BYTES:
        raise SoftkinError(
            f"{report}: the page would have {size / 1e6:.1f} MB, and a mail takes 10\n  mend: name fewer datasets, "
            "interval_methods or confidence_levels in config/config.yaml"
        )
    write_text(report, page)
    logger.info("%s: %.1f MB", report, size / 1e6)


def _read(path: Path) -> pd.DataFrame:
    """A table; what the paper printed stays text. One without any row has no columns either."""
    try:
        return pd.read_csv(path, dtype={"printed": str})
    except EmptyDataError:
        return pd.DataFrame()


def _scores(
    frames: Mapping[str, pd.DataFrame], models: Mapping[str, str], methods: Mapping[str, str], marks: Marks
) -> list[Grid]:
    level = float(frames["interval_choice"]["confidence_level"].iloc[0])
    return [
        point_grid(frames["point_metrics"], frames.get("selection"), models, marks),
        choice_grid(frames["interval_choice"], models, methods, marks),
        interval_grid(frames["interval_metrics"], models, methods, level, marks),
        *([searched_grid(frames["searched_runs"], models, marks)] if "searched_runs" in frames else []),
        *([spaces_grid(frames["target_spaces"], models, marks)] if len(frames["target_spaces"]) else []),
        outside_grid(frames["extrapolation_intervals"], models, methods, level, marks),
    ]


def _published(
    frames: Mapping[str, pd.DataFrame], models: Mapping[str, str], methods: Mapping[str, str], marks: Marks
) -> list[Grid]:
    """The comparisons that have rows: of datasets that the paper has no table of, there are none."""
    grids = []
    if len(frames.get("published_columns", ())):
        grids.append(published.best_grid(frames["published_columns"], models, marks))
    if len(frames["published_comparison"]):
        grids.append(published.cells_grid(frames["published_comparison"], models, marks))
    if len(frames["published_intervals"]):
        grids.append(published.intervals_grid(frames["published_intervals"], methods, marks))
    return grids


def _verdicts(frames: Mapping[str, pd.DataFrame]) -> list[str]:
    """The counts of verdicts, where the paper has cells to compare with."""
    cells, columns = frames["published_comparison"], frames.get("published_columns")
    return summary(cells, columns) if len(cells) else []


def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("softkin.report"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    environment.filters |= {"share": share_text, "kinds": kinds}
    return environment

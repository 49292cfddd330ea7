"""Write results/report.html: gather the results, lay them out, render the page."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from pandas.errors import EmptyDataError

from softkin.core.errors import ConfigError
from softkin.core.files import read_json, write_text
from softkin.core.samples import SUBSETS
from softkin.reporting.page import published
from softkin.reporting.page.cards import card_page
from softkin.reporting.page.extrapolation import outside_grid, searched_grid, spaces_grid
from softkin.reporting.page.grid import Grid, share_text
from softkin.reporting.page.headline import robot_cards
from softkin.reporting.page.images import pictures
from softkin.reporting.page.jobs import Job, duration, measured, slowest_grid
from softkin.reporting.page.marks import Marks, kinds
from softkin.reporting.page.provenance import citations, commit, data_grid, settings, versions
from softkin.reporting.page.scores import choice_grid, interval_grid, point_grid
from softkin.reporting.tables.published import summary
from softkin.reporting.titles import Titles

logger = logging.getLogger("softkin")

#: Stands for no dataset: names of datasets have no space.
ALL_ROBOTS = "all robots"
MAX_BYTES = 10_000_000


@dataclass(frozen=True)
class RobotFiles:
    """The files of one dataset that the page shows: description and data card (JSON), the card as a page (Markdown;
    may be empty), and the folder of its figures.
    """

    description: str | Path
    data_card: str | Path
    card_page: str | Path
    figures: str | Path


def build_report(
    *,
    tables: Sequence[str | Path],
    robots: Mapping[str, RobotFiles],
    campaign_figures: str | Path,
    jobs: Sequence[Job],
    config: Mapping[str, Any],
    titles: Titles,
    citation: str | Path,
    report: str | Path,
) -> None:
    """Write the page `report`, beside which the folders of figures lie.

    `tables` are files of results/tables; `robots` is dataset -> files; `campaign_figures` is the folder of the figures
    across datasets; `config` is the whole checked configuration; `citation` is CITATION.cff at the top of the checkout
    whose commit is told.

    Raises:
        ConfigError: the page would be larger than 10 MB.
    """
    frames = {Path(path).stem: _read(Path(path)) for path in tables}
    abouts = {dataset: read_json(files.description) for dataset, files in robots.items()}
    cards = {dataset: read_json(files.data_card) for dataset, files in robots.items()}
    sources = {dataset: config["sources"][dataset] for dataset in robots}
    marks = Marks(sources, abouts, cards)
    times = measured(jobs)
    names = {ALL_ROBOTS: "All robots"} | {dataset: about["title"] for dataset, about in abouts.items()}
    folders = {ALL_ROBOTS: Path(campaign_figures)} | {name: Path(files.figures) for name, files in robots.items()}
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
            robots=robot_cards(frames, abouts, titles.models, titles.methods, marks),
            verdicts=_verdicts(frames),
            data=data_grid(abouts, sources, marks),
            data_cards=cards,
            card_pages={dataset: card_page(files.card_page) for dataset, files in robots.items()},
            scores=_scores(frames, titles, marks),
            published=_published(frames, titles, marks),
            slowest=slowest_grid(times, titles.models),
            pictures=pictures(folders, names, Path(report).parent),
            titles=names,
            all_robots=ALL_ROBOTS,
            marks=marks,
            subsets=SUBSETS,
        )
    )
    size = len(page.encode())
    if size > MAX_BYTES:
        raise ConfigError(
            f"the page would have {size / 1e6:.1f} MB, and a mail takes 10",
            where=report,
            fix="name fewer datasets, interval_methods or confidence_levels in config/config.yaml",
        )
    write_text(report, page)
    logger.info("%s: %.1f MB", report, size / 1e6)


def _read(path: Path) -> pd.DataFrame:
    """A table; what the paper printed stays text. One without any row has no columns either."""
    try:
        return pd.read_csv(path, dtype={"printed": str})
    except EmptyDataError:
        return pd.DataFrame()


def _scores(frames: Mapping[str, pd.DataFrame], titles: Titles, marks: Marks) -> list[Grid]:
    level = float(frames["interval_choice"]["confidence_level"].iloc[0])
    return [
        point_grid(frames["point_metrics"], frames.get("selection"), titles.models, marks),
        choice_grid(frames["interval_choice"], titles.models, titles.methods, marks),
        interval_grid(frames["interval_metrics"], titles.models, titles.methods, level, marks),
        *([searched_grid(frames["searched_runs"], titles.models, marks)] if "searched_runs" in frames else []),
        *([spaces_grid(frames["target_spaces"], titles.models, marks)] if len(frames["target_spaces"]) else []),
        outside_grid(frames["extrapolation_intervals"], titles.models, titles.methods, level, marks),
    ]


def _published(frames: Mapping[str, pd.DataFrame], titles: Titles, marks: Marks) -> list[Grid]:
    """The comparisons that have rows: of datasets that the paper has no table of, there are none."""
    grids = []
    if len(frames.get("published_columns", ())):
        grids.append(published.best_grid(frames["published_columns"], titles.models, marks))
    if len(frames["published_comparison"]):
        grids.append(published.cells_grid(frames["published_comparison"], titles.models, marks))
    if len(frames["published_intervals"]):
        grids.append(published.intervals_grid(frames["published_intervals"], titles.methods, marks))
    return grids


def _verdicts(frames: Mapping[str, pd.DataFrame]) -> list[str]:
    """The counts of verdicts, where the paper has cells to compare with."""
    cells, columns = frames["published_comparison"], frames.get("published_columns")
    return summary(cells, columns) if len(cells) else []


def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("softkin.reporting.page"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    environment.filters |= {"share": share_text, "kinds": kinds}
    return environment

"""Write results/report.html: read the results, lay them out, render the page."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from pandas.errors import EmptyDataError

from softkin.core.csv_tables import read_csv
from softkin.core.errors import ConfigError
from softkin.core.files import read_json, write_text
from softkin.reporting.page import published
from softkin.reporting.page.cards import card_page
from softkin.reporting.page.choices import read_choices
from softkin.reporting.page.claims import claims_grid
from softkin.reporting.page.extrapolation import extrapolation_grid, searched_grid, spaces_grid
from softkin.reporting.page.grid import Grid
from softkin.reporting.page.headline import robot_cards
from softkin.reporting.page.images import Folder, albums
from softkin.reporting.page.jobs import Job, duration, measured, slowest_grid
from softkin.reporting.page.marks import Marks, bounds_of_fits, kinds
from softkin.reporting.page.orientation import orientation_grid
from softkin.reporting.page.provenance import data_grid, what_was_run
from softkin.reporting.page.recorded import recorded_grid
from softkin.reporting.page.scores import choice_grid, interval_grid, point_grid
from softkin.reporting.page.singles import read_singles
from softkin.reporting.tables.published import summary
from softkin.reporting.titles import Titles

logger = logging.getLogger("softkin")

MAX_BYTES = 10_000_000


@dataclass(frozen=True, slots=True)
class RobotFiles:
    """The files of one dataset that the page shows: description and data card (JSON), the card as Markdown, and the
    folder of its figures.
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
    """Write the page `report`.

    Parameters:
        tables: files of results/tables (CSV), which lie in `tables` beside the page.
        robots: dataset -> files, in the order of the configuration.
        campaign_figures: folder of the figures across datasets.
        jobs: the jobs that were timed.
        config: the whole checked configuration.
        titles: of models, interval methods, regions and labelled methods.
        citation: CITATION.cff at the top of the checkout whose commit the page names.
        report: path of the page, beside which the folders of figures lie.

    Raises:
        ConfigError: the page would be larger than 10 MB.
    """
    frames = {Path(path).stem: _read(Path(path)) for path in tables}
    descriptions = {dataset: read_json(files.description) for dataset, files in robots.items()}
    cards = {dataset: read_json(files.data_card) for dataset, files in robots.items()}
    sources = {dataset: config["sources"][dataset] for dataset in robots}
    marks = Marks(sources, descriptions, cards, {name: bounds_of_fits(config, name) for name in robots})
    times = measured(jobs)
    folders = [
        Folder(descriptions[dataset]["title"], files.figures, marks.of_dataset(dataset))
        for dataset, files in robots.items()
    ]
    page = _template().render(
        **what_was_run(config, Path(citation), sources),
        duration=duration(times),
        unit=marks.unit,
        robots=robot_cards(frames, descriptions, titles, marks),
        verdicts=_verdicts(frames),
        data=data_grid(descriptions, sources, marks),
        data_cards=cards,
        card_pages={dataset: card_page(files.card_page) for dataset, files in robots.items()},
        scores=_scores(frames, titles, marks),
        published=_published(frames, titles, marks),
        slowest=slowest_grid(times, titles.models),
        albums=albums([Folder("All robots", campaign_figures), *folders], Path(report).parent),
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
        return read_csv(path, dtype={"printed": str})
    except EmptyDataError:
        return pd.DataFrame()


def _scores(frames: Mapping[str, pd.DataFrame], titles: Titles, marks: Marks) -> list[Grid]:
    """The tables of scores; those on searched runs and target spaces where there are any."""
    choices, singles = read_choices(frames), read_singles(frames)
    level = float(frames["interval_choice"]["confidence_level"].iloc[0])
    grids = [
        point_grid(frames["point_metrics"], titles, marks, choices, singles),
        choice_grid(frames["interval_choice"], titles, marks, singles),
        interval_grid(frames["interval_metrics"], titles, level, marks, choices),
    ]
    if "searched_runs" in frames:
        grids.append(searched_grid(frames["searched_runs"], titles, marks, choices))
    if len(frames["target_spaces"]):
        grids.append(spaces_grid(frames["target_spaces"], titles, marks))
    if len(frames.get("recorded", ())):
        grids.append(recorded_grid(frames["recorded"], titles, marks))
    if "orientation" in frames:
        grids.append(orientation_grid(frames["orientation"], titles, marks))
    return [*grids, extrapolation_grid(frames["extrapolation_intervals"], titles, level, marks, choices)]


def _published(frames: Mapping[str, pd.DataFrame], titles: Titles, marks: Marks) -> list[Grid]:
    """The comparisons that have rows: there are none of datasets that the paper has no table of."""
    grids = [claims_grid(frames["claims"])] if len(frames.get("claims", ())) else []
    if len(frames.get("published_columns", ())):
        grids.append(published.best_grid(frames["published_columns"], titles, marks))
    if len(frames["published_comparison"]):
        grids.append(published.cells_grid(frames["published_comparison"], titles, marks))
    if len(frames["published_intervals"]):
        grids.append(published.intervals_grid(frames["published_intervals"], titles, marks))
    return grids


def _verdicts(frames: Mapping[str, pd.DataFrame]) -> list[str]:
    """The counts of verdicts, where the paper has cells to compare with."""
    cells, columns = frames["published_comparison"], frames.get("published_columns")
    return summary(cells, columns) if len(cells) else []


def _template() -> Any:
    environment = Environment(
        loader=PackageLoader("softkin.reporting.page"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    environment.filters["kinds"] = kinds
    return environment.get_template("page.html.j2")

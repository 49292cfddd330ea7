"""All tables of results/tables, from the scores of every dataset."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.core.files import read_json, replacing, write_text
from softkin.core.runs import TUNED
from softkin.core.samples import TEST
from softkin.data.audit.findings import leak_notes, leaking_subsets
from softkin.reporting.tables.headline import headline
from softkin.reporting.tables.interval_choice import interval_choice
from softkin.reporting.tables.interval_layout import interval_table
from softkin.reporting.tables.leaks import marked
from softkin.reporting.tables.paper_layout import SUBSET_TITLES, PaperTable, comparison_table, subset_table
from softkin.reporting.tables.published import compare, compare_columns, read_published, summary
from softkin.reporting.tables.published_intervals import compare_intervals, read_published_intervals, table_6
from softkin.reporting.titles import Titles
from softkin.training.selection import deployed, foretold, searched_runs, selection


@dataclass(frozen=True)
class DatasetFiles:
    """The files of one dataset that tables are made of: its scores (CSV), what is chosen, and its description and data
    card (JSON).
    """

    point: str | Path
    markers: str | Path
    intervals: str | Path
    choice: str | Path
    conditional: str | Path
    alarms: str | Path
    extrapolation: str | Path
    spaces: str | Path
    description: str | Path
    data_card: str | Path


@dataclass(frozen=True)
class PublishedFiles:
    """What the paper printed (CSV): cells of its point metrics, sizes of its subsets, cells of its Table 6."""

    point: str | Path
    subsets: str | Path
    intervals: str | Path


class Tables:
    """The tables of a run, as frames.

    `datasets` is name -> files, in the order of the configuration; `sources` are the datasets' entries of
    config/datasets.yaml; `parameters` is (dataset, model, preset) -> file of what a study found, empty when nothing
    was searched; `objective` is what the deployed models are chosen for.
    """

    def __init__(
        self,
        datasets: Mapping[str, DatasetFiles],
        *,
        sources: Mapping[str, Mapping[str, Any]],
        parameters: Mapping[tuple[str, str, str], str | Path],
        objective: str,
        published: PublishedFiles,
    ) -> None:
        files = list(datasets.values())
        self.abouts = [read_json(of.description) for of in files]
        self.cards = [read_json(of.data_card) for of in files]
        leaks = {card["dataset"]: leaking_subsets(card) for card in self.cards}
        self.notes = _notes(sources, self.abouts, self.cards)
        self.point = marked(_together(of.point for of in files), leaks)
        self.cells = compare(read_published(published.point), self.point, self.notes)
        self.columns = compare_columns(self.cells, self.point) if f"{TUNED}_value" in self.cells else None
        self.intervals = marked(_together(of.intervals for of in files), leaks, calibrated=True)
        printed = read_published_intervals(published.intervals)
        self.interval_cells = compare_intervals(printed, self.intervals, self.point)
        choices = {name: pd.read_csv(of.choice) for name, of in datasets.items()}
        self.choice = marked(interval_choice(choices, self.intervals), leaks, calibrated=True)
        searched = searched_runs(parameters) if parameters else None
        self.selection = None if searched is None else selection(searched, objective)
        self.frames = {
            "point_metrics": self.point,
            "marker_errors": marked(_together(of.markers for of in files), leaks),
            "published_comparison": self.cells,
            "interval_metrics": self.intervals,
            "published_intervals": self.interval_cells,
            "interval_choice": self.choice,
            "conditional_coverage": marked(_together(of.conditional for of in files), leaks, calibrated=True),
            "alarm_rates": marked(_together(of.alarms for of in files), leaks, calibrated=True),
            "extrapolation_intervals": marked(_together(of.extrapolation for of in files), leaks, calibrated=True),
            "target_spaces": marked(_together(of.spaces for of in files), leaks),
        }
        if self.columns is not None:
            self.frames["published_columns"] = self.columns
        if searched is not None and self.selection is not None:
            self.frames |= {"selection": self.selection, "searched_runs": foretold(searched, self.point)}


def build_tables(
    tables: Tables,
    *,
    sources: Mapping[str, Mapping[str, Any]],
    published_subsets: str | Path,
    titles: Titles,
    folder: Path,
) -> None:
    """Write every table into `folder`: each frame as CSV, those for a paper as Markdown and LaTeX, the headline."""
    for name, frame in tables.frames.items():
        with replacing(folder / f"{name}.csv") as temporary:
            frame.to_csv(temporary, index=False)
    robots = {name: entry["title"] for name, entry in sources.items()}
    laid_out = [subset_table(tables.abouts, pd.read_csv(published_subsets))]
    laid_out += _comparisons(tables, sources, titles.models)
    if len(tables.interval_cells):
        laid_out.append(table_6(tables.interval_cells, robots, dict(titles.methods)))
    sentences = summary(tables.cells, tables.columns)
    write_text(folder / "paper_tables.md", "\n".join([_preface(sentences), *(table.markdown() for table in laid_out)]))
    write_text(folder / "paper_tables.tex", "\n".join(table.latex() for table in laid_out))
    remarks = [f"{robots[dataset]}, {s}: {note}" for (dataset, s), note in tables.notes.items() if s == TEST]
    ours = interval_table(tables.intervals, tables.choice, robots, titles.models, titles.methods, remarks)
    write_text(folder / "interval_tables.md", ours.markdown())
    write_text(folder / "interval_tables.tex", ours.latex())
    best = None if tables.selection is None else deployed(tables.selection)
    leaking = [card["dataset"] for card in tables.cards if card["is_leaking"]]
    write_text(folder / "headline.txt", headline(best, tables.point, tables.choice, sentences, leaking))


def _together(paths: Iterable[str | Path]) -> pd.DataFrame:
    return pd.concat([pd.read_csv(path) for path in paths], ignore_index=True)


def _notes(
    sources: Mapping[str, Mapping[str, Any]], abouts: Sequence[Mapping[str, Any]], cards: Sequence[Mapping[str, Any]]
) -> dict[tuple[str, str], str]:
    """What a reader must know, by (dataset, subset): the entries' notes, leaks, and that rows were left out."""
    found = [
        ((name, subset), note) for name, entry in sources.items() for subset, note in entry.get("notes", {}).items()
    ]
    found += [((card["dataset"], subset), note) for card in cards for subset, note in leak_notes(card).items()]
    warning = "Not comparable with the paper: max_rows_per_subset left rows out."
    found += [((about["dataset"], subset), warning) for about in abouts if about["is_cut"] for subset in SUBSET_TITLES]
    notes: dict[tuple[str, str], str] = {}
    for key, note in found:
        notes[key] = f"{notes.get(key, '')} {note}".strip()
    return notes


def _comparisons(
    tables: Tables, sources: Mapping[str, Mapping[str, Any]], model_titles: Mapping[str, str]
) -> list[PaperTable]:
    notes = tables.notes
    laid_out = []
    for dataset, entry in sources.items():
        remarks = [f"{SUBSET_TITLES[s]}: {notes[dataset, s]}" for s in SUBSET_TITLES if (dataset, s) in notes]
        about = entry.get("paper_table"), dataset, entry["title"]
        laid_out.append(comparison_table(*about, tables.point, tables.cells, model_titles, remarks))
    return laid_out


def _preface(sentences: Sequence[str]) -> str:
    lines = ["# The paper's Tables 2 to 6 beside ours", "", *(f"- {sentence}" for sentence in sentences), ""]
    explanation = (
        "Each metric has three columns: the cell as printed, our paper preset (the paper's settings), our tuned "
        "preset. The best cell of each column is bold. Errors are averaged over coordinates, those that never move "
        "included, as the paper does; `point_metrics.csv` has the same without them.\n"
    )
    return "\n".join([*lines, explanation])

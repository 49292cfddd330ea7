"""Read the results of every dataset into the tables of a run, as data frames."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from softkin.core.csv_tables import read_csv
from softkin.core.files import read_json
from softkin.core.runs import TUNED
from softkin.data.audit.findings import leak_notes, leaking_subsets
from softkin.reporting.tables.claims import claims
from softkin.reporting.tables.interval_choice import interval_choice
from softkin.reporting.tables.leaks import marked
from softkin.reporting.tables.paper_layout import SUBSET_TITLES
from softkin.reporting.tables.published import compare, compare_columns, read_published
from softkin.reporting.tables.published_intervals import compare_intervals, read_published_intervals
from softkin.reporting.units import with_units
from softkin.training.selection import runs_with_errors, searched_runs, selection

CUT = "Not comparable with the paper: max_rows_per_subset left rows out."


@dataclass(frozen=True, slots=True)
class DatasetFiles:
    """The files of one dataset that tables are made of: its scores and its interval choice (CSV), its description and
    its data card (JSON).
    """

    point: str | Path
    markers: str | Path
    intervals: str | Path
    choice: str | Path
    conditional: str | Path
    alarms: str | Path
    extrapolation: str | Path
    spaces: str | Path
    left_out: str | Path
    description: str | Path
    data_card: str | Path


@dataclass(frozen=True, slots=True)
class PublishedFiles:
    """What the paper printed (CSV): cells of its point metrics, sizes of its subsets, cells of its Table 6, grades of
    its Table 1, improvements that it states.
    """

    point: str | Path
    subsets: str | Path
    intervals: str | Path
    approaches: str | Path
    improvements: str | Path


@dataclass(frozen=True, slots=True)
class Tables:
    """The tables of a run: `frames` by the name of their CSV file, and what their layouts need besides.

    `sources` are the datasets' entries of config/datasets.yaml, `descriptions` and `cards` their dataset.json and
    data_card.json, in the same order; `notes` is (dataset, subset) -> what a reader must know; `published_subsets` are
    the sizes that the paper printed.
    """

    frames: Mapping[str, pd.DataFrame]
    sources: Mapping[str, Mapping[str, Any]]
    descriptions: Sequence[Mapping[str, Any]]
    cards: Sequence[Mapping[str, Any]]
    notes: Mapping[tuple[str, str], str]
    published_subsets: pd.DataFrame


def read_tables(
    datasets: Mapping[str, DatasetFiles],
    *,
    sources: Mapping[str, Mapping[str, Any]],
    parameters: Mapping[tuple[str, str, str], str | Path],
    objective: str,
    published: PublishedFiles,
    recorded: Sequence[str | Path] = (),
    learning: Sequence[str | Path] = (),
    orientation: Sequence[str | Path] = (),
) -> Tables:
    """The tables of a run. There is no published_columns without tuned models, and no selection and searched_runs where
    nothing was searched; recorded, learning_curve and orientation where files of them are given. Without a published
    dataset `claims` has no rows. Where a dataset is not in mm all have a column `unit`.

    Parameters:
        datasets: dataset -> files, in the order of the configuration.
        sources: the datasets' entries of config/datasets.yaml.
        parameters: (dataset, model, preset) -> file of best parameters; empty where nothing was searched.
        objective: what the deployed models are chosen for.
        published: what the paper printed.
        recorded: files of scores in time, of the recorded datasets.
        learning: files of learning curves.
        orientation: files of scores of orientations.
    """
    files = list(datasets.values())
    descriptions = [read_json(paths.description) for paths in files]
    cards = [read_json(paths.data_card) for paths in files]
    leaks = {card["dataset"]: leaking_subsets(card) for card in cards}
    notes = _notes(sources, descriptions, cards)

    point = marked(_concatenated(paths.point for paths in files), leaks)
    intervals = marked(_concatenated(paths.intervals for paths in files), leaks, calibrated=True)
    cells = compare(read_published(published.point), point, notes)
    choices = {name: read_csv(paths.choice) for name, paths in datasets.items()}
    frames = {
        "point_metrics": point,
        "marker_errors": marked(_concatenated(paths.markers for paths in files), leaks),
        "published_comparison": cells,
        "interval_metrics": intervals,
        "published_intervals": compare_intervals(read_published_intervals(published.intervals), intervals, point),
        "interval_choice": marked(interval_choice(choices, intervals), leaks, calibrated=True),
        "conditional_coverage": marked(_concatenated(paths.conditional for paths in files), leaks, calibrated=True),
        "alarm_rates": marked(_concatenated(paths.alarms for paths in files), leaks, calibrated=True),
        "extrapolation_intervals": marked(
            _concatenated(paths.extrapolation for paths in files), leaks, calibrated=True
        ),
        "target_spaces": marked(_concatenated(paths.spaces for paths in files), leaks),
        "left_out": _left_out(files),
    }
    if f"{TUNED}_value" in cells:
        frames["published_columns"] = compare_columns(cells, point)
    if parameters:
        searched = searched_runs(parameters)
        frames |= {"selection": selection(searched, objective), "searched_runs": runs_with_errors(searched, point)}
    frames |= _of_some(leaks, recorded=recorded, learning_curve=learning, orientation=orientation)
    printed = {name: read_csv(getattr(published, name)) for name in ("subsets", "approaches", "improvements")}
    frames["claims"] = claims(frames, printed, descriptions, cards)
    return Tables(with_units(frames, descriptions), sources, descriptions, cards, notes, printed["subsets"])


def _of_some(leaks: Mapping[str, Collection[str]], **files: Sequence[str | Path]) -> dict[str, pd.DataFrame]:
    """Tables that some datasets have rows of, by name; none of those without files."""
    return {name: marked(_concatenated(paths), leaks) for name, paths in files.items() if paths}


def _left_out(files: Sequence[DatasetFiles]) -> pd.DataFrame:
    """Scores with one row or coordinate left out; those of point models have no method, which is no missing number."""
    frames = [read_csv(paths.left_out, dtype={"interval_method": str}) for paths in files]
    return pd.concat(frames, ignore_index=True).fillna({"interval_method": ""})


def _concatenated(paths: Iterable[str | Path]) -> pd.DataFrame:
    return pd.concat([read_csv(path) for path in paths], ignore_index=True)


def _notes(
    sources: Mapping[str, Mapping[str, Any]],
    descriptions: Sequence[Mapping[str, Any]],
    cards: Sequence[Mapping[str, Any]],
) -> dict[tuple[str, str], str]:
    """What a reader must know, by (dataset, subset): the entries' notes, leaks, and that rows were left out."""
    pairs = [
        ((name, subset), note) for name, entry in sources.items() for subset, note in entry.get("notes", {}).items()
    ]
    pairs += [((card["dataset"], subset), note) for card in cards for subset, note in leak_notes(card).items()]
    pairs += [((of["dataset"], subset), CUT) for of in descriptions if of["is_cut"] for subset in SUBSET_TITLES]
    notes: dict[tuple[str, str], str] = {}
    for key, note in pairs:
        notes[key] = f"{notes.get(key, '')} {note}".strip()
    return notes
